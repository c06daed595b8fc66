"""Chapter 8: broad fuzzy neural adaptive impedance control for optimal robot-environment interaction."""

TITLE = "Broad fuzzy neural adaptive impedance control for optimal robot-environment interaction"
ORDER = (
    "circle_tracking",
    "unknown_object",
    "sponge",
)
