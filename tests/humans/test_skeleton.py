import numpy as np
import pytest

from dexrepro.humans.skeleton import JOINTS, Body, DepthCamera, Occlusion, carry

CENTRES = [(-15, 32, -25), (-12, 36, -8), (12, 36, -8), (16, 32, -25)]
INSTANTS = [0, 0.3, 0.7, 1]


def truth(count: int = 200) -> np.ndarray:
    return carry(np.linspace(0, 1, count), Body(), CENTRES, INSTANTS, np.radians(25), np.radians(8))


def lengths(joints: np.ndarray, a: str, b: str) -> np.ndarray:
    return np.linalg.norm(joints[..., JOINTS.index(a), :] - joints[..., JOINTS.index(b), :], axis=-1)


def test_links_and_box_keep_their_lengths_while_carrying():
    joints = truth()
    for side in ("left", "right"):
        np.testing.assert_allclose(lengths(joints, f"{side}_shoulder", f"{side}_elbow"), 22)
        np.testing.assert_allclose(lengths(joints, f"{side}_elbow", f"{side}_wrist"), 28)
    np.testing.assert_allclose(lengths(joints, "left_wrist", "right_wrist"), 33)


def test_a_box_out_of_reach_is_refused():
    with pytest.raises(ValueError, match="out of reach"):
        carry(np.linspace(0, 1, 50), Body(), [(0, 60, 0), (0, 70, 0)], [0, 1], 0.0, 0.0)


def test_camera_without_noise_reports_the_truth():
    joints = truth()
    camera = DepthCamera(noise=(0.0, 0.0, 0.0), bursts=0.0)
    np.testing.assert_allclose(
        camera.observe(joints, 3, np.random.default_rng(0)), np.broadcast_to(joints, (3, 200, 6, 3))
    )


def test_noise_vanishes_in_the_mean_of_many_but_occlusion_does_not():
    joints, rng = truth(), np.random.default_rng(1)
    hidden = Occlusion(0.5, 0.15, (-10.0, 0.0, 0.0))
    camera = DepthCamera(occlusions={"left_wrist": hidden}, bursts=0.0)
    bias = camera.observe(joints, 400, rng).mean(0) - joints
    wrist = JOINTS.index("left_wrist")
    assert bias[100, wrist, 0] == pytest.approx(-10, abs=0.5)
    others = np.delete(bias, wrist, axis=1)
    assert np.abs(others).max() < 0.6


def test_reported_noise_has_the_stated_size():
    camera = DepthCamera(noise=(1.0, 1.5, 2.0), bursts=0.0)
    still = np.zeros((400, 6, 3))
    spread = camera.observe(still, 40, np.random.default_rng(2)).std(axis=(0, 1, 3))
    np.testing.assert_allclose(spread, np.tile([1.0, 1.5, 2.0], 2) * np.hypot(0.9, 0.4), rtol=0.03)
