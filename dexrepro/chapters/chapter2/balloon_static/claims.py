"""What the book says about ``balloon_static``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import about, every, less, within

_STARTS, _UNREGULATED = ("off_80", "off_100"), ("unregulated_80", "unregulated_100")

fig_2_10 = about("2.10", "2.4.2.1")
CLAIMS = (
    fig_2_10(
        "C2.20",
        "The follower finds the holding position from any initial offset.",
        every(*(less(f".{start}.lateral_offset", 2e-3) for start in _STARTS)),
        control=every(*(less(f".{start}.lateral_offset", 2e-3) for start in _UNREGULATED)),
    ),
    fig_2_10(
        "C2.21",
        "Both starts lead to the same destination.",
        less(".destination_spread", 2e-3),
        control=less(".unregulated_spread", 2e-3),
    ),
    fig_2_10(
        "C2.22",
        "The lateral forces f_x and f_z converge to zero.",
        every(*(less(f".{start}.lateral_force_time", 2.0) for start in _STARTS)),
        control=every(*(less(f".{start}.lateral_force_time", 2.0) for start in _UNREGULATED)),
    ),
    fig_2_10(
        "C2.23",
        "The force along the holding line converges to 10 N.",
        every(*(within(f".{start}.force_along", 9.8, 10.2) for start in _STARTS)),
        control=within(".force.force_along", 9.8, 10.2),
        note="Within 5 % after {.off_80.settling_time:.1f} s, a time that the smoothing sets. The "
        "control is the printed force controller, which stays at {.force.force_along:.2g} N.",
    ),
)
