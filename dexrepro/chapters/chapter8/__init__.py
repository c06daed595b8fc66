"""Chapter 8: broad fuzzy neural adaptive impedance control for optimal robot-environment interaction."""

TITLE = "Broad fuzzy neural adaptive impedance control for optimal robot-environment interaction"
ORDER = (
    "circle_tracking",
    "unknown_object",
    "sponge",
)
FAIRNESS = (
    "Networks share the printed gains, the leakage, the rates and the width of their Gaussians, as the chapter says. "
    "What a network's structure is credited with is judged beside one constant node a network, which makes it "
    "integral action on the same error, at equal effective gain: rate times mean squared length of the features over "
    "5 to 10 s, the part over which all errors are compared. H-infinity control has the law's stiffness; the "
    "regulator starts from the same K_0, and beside it stands one that is told the object."
)
