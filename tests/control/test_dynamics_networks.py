import numpy as np
import pytest

from dexrepro.control.dynamics_networks import KINDS, dynamics_networks

LEVELS = dict(position_levels=[0.1, 0.2, 0.3], velocity_levels=[0.01, 0.02, 0.03])


def build(kind, thresholds=(0.1, 0.3, 0.1)):
    return dynamics_networks(
        kind, 2, widths=[0.1] * 3, rates=[1.0] * 3, leakage=5.0, thresholds=thresholds, neighbours=1,
        placement=1.0, step=1e-3, **LEVELS,
    )  # fmt: skip


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_maps_the_motion_to_the_terms_of_the_dynamics(kind):
    point, motion = np.array([0.15, 0.2]), np.array([0.15, 0.2, 0.01, 0.0])
    shapes = [net.output(z, grow=True).shape for net, z in zip(build(kind), (point, motion, point))]
    assert shapes == [(4,), (4,), (2,)]


def test_the_grids_have_the_printed_number_of_nodes():
    assert [network.basis.capacity for network in build("fuzzy")] == [9, 81, 9]
    assert [network.basis.capacity // 3 for network in build("fuzzy_enhanced")] == [9, 81, 9]


def test_an_enhanced_grid_has_the_gaussians_of_the_plain_one_and_never_grows():
    plain, enhanced = build("fuzzy")[2].basis, build("fuzzy_enhanced")[2].basis
    for point in ([0.1, 0.3], [5.0, 5.0]):
        features = enhanced(point, grow=True).reshape(-1, 3)
        assert features[:, 0] == pytest.approx(plain(point))
        assert features[:, 1] == pytest.approx(np.cos(plain(point)))
    enhanced.reset()
    assert enhanced.nodes == 9


def test_mass_and_gravity_share_a_basis_where_it_is_the_same_for_both():
    inertia, coriolis, gravity = build("broad")
    assert inertia.basis is gravity.basis
    assert inertia.basis is not coriolis.basis
    inertia, _, gravity = build("broad", thresholds=(0.1, 0.3, 0.2))
    assert inertia.basis is not gravity.basis


def test_an_unknown_kind_is_refused():
    with pytest.raises(ValueError, match="none of"):
        build("narrow")
