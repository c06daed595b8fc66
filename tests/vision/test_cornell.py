import numpy as np
import pytest

from dexrepro.vision.cornell import COLUMNS, ROWS, NotCornell, labelled, pictures
from dexrepro.vision.tabletop import BAD, SAFE, UNSAFE

HEADER = "# .PCD v.7\nVERSION .7\nFIELDS x y z rgb index\nSIZE 4 4 4 4 4\nDATA ascii\n"


@pytest.fixture
def folder(tmp_path):
    """One picture in the format of the data set: two good rectangles (one with an undefined corner), one bad."""
    image = pytest.importorskip("PIL.Image")
    place = tmp_path / "01"
    place.mkdir()
    image.fromarray(np.full((ROWS, COLUMNS, 3), 128, dtype=np.uint8)).save(place / "pcd0100r.png")
    pixels = [(row, column) for row in range(150, 330, 2) for column in range(200, 440, 2)]
    points = "\n".join(f"0 0 {-900 - row} 0 {row * COLUMNS + column}" for row, column in pixels)
    (place / "pcd0100.txt").write_text(HEADER + points + "\n")
    good = "300 200\n300 220\n360 220\n360 200\n" + "50 200\n50 220\n90 220\n90 200\n" + "nan nan\n1 1\n2 2\n3 3\n"
    (place / "pcd0100cpos.txt").write_text(good)
    (place / "pcd0100cneg.txt").write_text("400 300\n420 300\n420 350\n400 350\n")
    return tmp_path


def test_rectangles_become_grasps_that_close_across_the_plates(folder):
    _, good, bad = next(pictures(folder))
    assert (len(good), len(bad)) == (2, 1)
    first = good[0]
    assert (first.x, first.y, first.width) == pytest.approx((330, 210, 60))
    assert first.angle == pytest.approx(0.0)
    assert first.z == pytest.approx(-1110)


def test_labels_follow_the_made_up_boundary(folder):
    patches, labels = labelled(folder)
    assert patches.shape == (3, 7, 24, 24)
    assert labels.tolist() == [SAFE, UNSAFE, BAD]
    assert np.isfinite(patches).all()


def test_another_folder_is_refused(tmp_path):
    with pytest.raises(NotCornell, match="Cornell"):
        next(pictures(tmp_path))
