"""Chapter 3: a redundant arm works through a small opening."""

TITLE = "Working through a small opening about a remote centre of motion"
ORDER = (
    "settling_time",
    "fixed_opening",
    "external_push",
    "moving_opening",
    "grasp_classes",
    "grasp_through_opening",
)
