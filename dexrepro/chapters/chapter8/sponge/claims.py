"""What the book says about ``sponge``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, Reference, every, greater, less

SPONGE = "sponge"

CLAIMS = (
    Claim(
        "C8.16",
        "8.13",
        "On the Baxter arm the error stays inside 0.1 m.",
        every(less(f"{SPONGE}.learned.bound_used", 1.0), less(f"{SPONGE}.lqr.bound_used", 1.0)),
        where="8.5",
        note="At 1 kHz with the arm's own gravity compensation, and with its exact inertia in what holds the redundant "
        "joints (the law itself has no model); simulated sponge.",
    ),
    Claim(
        "C8.17",
        "8.13",
        "The learned law compresses the sponge less than the regulator.",
        less(f"{SPONGE}.learned.final_compression", f"{SPONGE}.lqr.final_compression"),
        printed=less(f"{SPONGE}.learned.final_compression", f"{SPONGE}.lqr_printed_environment.final_compression"),
        where="8.5",
        note="For our sponge of 400 N/m. Below about 330 N/m, which the weights and the regulator's model fix, it "
        "fails.",
    ),
    Claim(
        "C8.17p",
        "8.13",
        "It also has the lower peak compression, learning included.",
        less(f"{SPONGE}.learned.peak_compression", f"{SPONGE}.lqr.peak_compression"),
        source="ours",
        note="The stiff initial gain and the exploration, both our choice, press 36 mm deep.",
    ),
    Claim(
        "C8.17s",
        "8.C",
        "It compresses a softer sponge, 150 N/m, less than the regulator.",
        less(f"{SPONGE}.soft_learned.final_compression", f"{SPONGE}.soft_lqr.final_compression"),
        source="ours",
    ),
    Claim(
        "C8.18",
        "8.13",
        "The numbers of nodes grow and remain stable.",
        every(less(f"{SPONGE}.learned.late_growth", 0.5), greater(f"{SPONGE}.learned.nodes_d", 1.5)),
        where="8.5",
    ),
    Claim(
        "C8.19",
        "8.14",
        "The gain converges on the sponge (to the optimal one).",
        every(less(f"{SPONGE}.learned.gain_error", 0.01), less(f"{SPONGE}.learned.iterations", 10.0)),
        where="8.5",
    ),
)
REFERENCES = (
    Reference(f"{SPONGE}.learned.nodes_d", 14, "8.5"),
    Reference(f"{SPONGE}.learned.nodes_c", 35, "8.5"),
    Reference(f"{SPONGE}.learned.nodes_g", 38, "8.5"),
)
