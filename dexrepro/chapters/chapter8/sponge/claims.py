"""What the book says about ``sponge``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, Predicate, Reference, about, every, greater, less, within


def optimal(case: str) -> Predicate:
    """K_x (negative) is to 1 % that of a regulator told the sponge."""
    gain, best = f".{case}.gain_x", ".lqr_true.gain_x"
    return every(greater(gain, best, 1.01), less(gain, best, 0.99))


fig_8_13 = about("8.13", "8.5")
CLAIMS = (
    fig_8_13(
        "C8.16",
        "On the Baxter arm the error stays inside 0.1 m.",
        every(less(".learned.bound_used", 1.0), less(".lqr.bound_used", 1.0)),
        control=every(less(".no_barrier_learned.bound_used", 1.0), less(".no_barrier.bound_used", 1.0)),
        credits="the barrier of the proposed control",
        printed=less(".at_50_hz.bound_used", 1.0),
        note="The regulator's run uses {.lqr.bound_used:.1%} of it, and without the barrier "
        "{.no_barrier.bound_used:.1%}. At the printed 50 Hz a bound is violated after {.at_50_hz.stopped_at:.2f} s on "
        "our model, which has no inner joint loops (E8.17). At 1 kHz with the arm's own gravity compensation, and with "
        "its exact inertia in what holds the redundant joints (the law itself has no model); simulated sponge.",
    ),
    fig_8_13(
        "C8.17",
        "The learned law compresses the sponge less than the regulator.",
        less(".learned.final_compression", ".lqr.final_compression"),
        control=less(".lqr_true.final_compression", ".lqr.final_compression"),
        credits="the adaptive impedance",
        printed=less(".learned.final_compression", ".lqr_printed_environment.final_compression"),
        note="At equal knowledge it is a tie: {.learned.final_compression:.2f} mm learned, "
        "{.lqr_true.final_compression:.2f} mm for a regulator told the sponge of {.sponge.stiffness} N/m, "
        "{.lqr.final_compression:.2f} mm for one told 7 N/m. Below {.crossing_stiffness:.0f} N/m, which "
        "the weights and the regulator's model fix, the wrong model compresses less.",
    ),
    Claim(
        "C8.17p",
        "8.13",
        "It also has the lower peak compression, learning included.",
        less(".learned.peak_compression", ".lqr.peak_compression"),
        source="ours",
        note="The stiff initial gain and the exploration, both our choice, press {.learned.peak_compression:.0f} "
        "mm deep.",
    ),
    Claim(
        "C8.17s",
        "8.C",
        "It compresses a softer sponge, 150 N/m, less than the regulator.",
        less(".soft_learned.final_compression", ".soft_lqr.final_compression"),
        source="ours",
    ),
    fig_8_13(
        "C8.18",
        "The numbers of nodes grow and remain stable.",
        every(less(".learned.late_growth", 0.5), *(greater(f".learned.nodes_{name}", 1.5) for name in "dcg")),
        control=every(*(greater(f".one_node.nodes_{name}", 1.5) for name in "dcg")),
        credits="networks that grow",
        readings={
            "joint angles and rates as inputs": every(*(greater(f".learned.joint_nodes_{name}", 1.5) for name in "dc"))
        },
        note="With task-space inputs there are {.learned.nodes_d:.0f}, {.learned.nodes_c:.0f} and "
        "{.learned.nodes_g:.0f} nodes at the end: that of C is the first and only one.",
    ),
    fig_8_13(
        "C8.18b",
        "They remain stable at 14, 35 and 38.",
        every(*(within(f".learned.nodes_{name}", n - 0.5, n + 0.5) for name, n in zip("dcg", (14, 35, 38)))),
        no_control="D and G have one threshold and, as printed, one input: their counts are equal whatever is run",
        searched="task-space inputs, and joint angles and rates as inputs, with the printed thresholds",
        note="Task-space inputs make {.learned.nodes_d:.0f}, {.learned.nodes_c:.0f} and "
        "{.learned.nodes_g:.0f}, joint inputs {.learned.joint_nodes_d:.0f} for D and G and "
        "{.learned.joint_nodes_c:.0f} for C. The inputs of the networks, m and beta_1 are not printed (E8.16).",
    ),
    Claim(
        "C8.19",
        "8.14",
        "The gain converges on the sponge (to the optimal one).",
        every(less(".learned.gain_error", 0.01), less(".learned.iterations", 10.0)),
        control=optimal("lqr"),
        printed=less(".desired_path.gain_error", 0.01),
        where="8.5",
        note="Regressed on the desired path itself (E8.09) K_x is {.desired_path.gain_x:.0f} N/m in place of "
        "{.learned.gain_x:.0f}, and a bound is violated after {.desired_path.stopped_at:.1f} s.",
    ),
)
REFERENCES = (
    Reference(".learned.nodes_d", 14, "8.5"),
    Reference(".learned.nodes_c", 35, "8.5"),
    Reference(".learned.nodes_g", 38, "8.5"),
)
