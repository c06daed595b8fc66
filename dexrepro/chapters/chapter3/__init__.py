"""Chapter 3: a redundant arm works through a small opening."""

FAIRNESS = (
    "Whatever is compared shares the printed gains, the reference, the task, the box and the error of the nominal "
    "model; what is credited is taken away alone. Instead of the network stands an integrator, one constant node at "
    "the same gain. Laws that are tuned get as many settings and no more torque than the printed gains need."
)
TITLE = "Working through a small opening about a remote centre of motion"
ORDER = (
    "settling_time",
    "fixed_opening",
    "external_push",
    "moving_opening",
    "grasp_classes",
    "grasp_through_opening",
)
