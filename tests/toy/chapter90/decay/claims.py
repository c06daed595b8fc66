from dexrepro.claims import Claim, Reference, less, within

CLAIMS = (
    Claim(
        "C90.01",
        "90.10",
        "the fast one decays more",
        less("decay.fast.final", "decay.plain.final"),
        beside="Elsewhere it begins at {decay.fast.largest:.2f} m.",
    ),
    Claim(
        "C90.02",
        "90.10",
        "nothing grows",
        within("decay.plain.largest", 0, 0.5),
        beside="Elsewhere it ends at {needs_more.only.final:.2f} m.",
    ),
    Claim("C90.03", "90.10", "the smallest gain wins", less("decay.gain1.final", "decay.gain2.final", 3)),
)
REFERENCES = (Reference("decay.plain.final", 0.018, "90.1", "m"),)
