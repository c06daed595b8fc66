"""The hand-over from the potential field to force control at first contact, Section 1.4."""

from __future__ import annotations


class ContactLatch:
    """Says whether there is contact, from the measured force.

    Closes when the force has been above ``threshold`` [N] for ``samples`` control periods in a row, opens when it has
    been below ``release`` [N] for ``release_samples``. With release = threshold and single samples it is a bare
    comparison, which chatters on a light touch.
    """

    def __init__(self, *, threshold: float, samples: int, release: float, release_samples: int) -> None:
        if release > threshold:
            raise ValueError(f"the latch opens at {release} N, above the {threshold} N at which it closes")
        self.threshold, self.samples = threshold, samples
        self.release, self.release_samples = release, release_samples
        self.reset()

    def reset(self) -> None:
        """Open the latch and forget the samples seen."""
        self.closed, self.count, self.switches = False, 0, 0

    def __call__(self, force: float) -> bool:
        """True while in contact; ``force`` [N] is the measured magnitude along the holding line."""
        against = force < self.release if self.closed else force > self.threshold
        self.count = self.count + 1 if against else 0
        if self.count >= (self.release_samples if self.closed else self.samples):
            self.closed, self.count = not self.closed, 0
            self.switches += 1
        return self.closed
