"""What Chapter 4 says and no experiment can test, with the reasons."""

from __future__ import annotations

from dexrepro.claims import Claim

CLAIMS = (
    Claim(
        "C4.18a",
        "4.8",
        "Nodes far from a new orbit keep what they learned, because Gaussians are local.",
        None,
        where="Remark 4.1(4)",
        not_testable="all orbits of the task lie within one width of the same nodes; that s_i and sin(s_i) vanish with "
        "distance is their definition",
    ),
    Claim(
        "C4.27",
        "4.12",
        "The measured error curves of the real robot.",
        None,
        where="4.6",
        not_testable="they belong to one physical robot and its payload; axes without readable numbers",
    ),
)
