"""Fuzzy system of product rules with Gaussian sets, a singleton fuzzifier and centre-average defuzzification."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from dexrepro.arrays import Array


class FuzzySystem:
    """Rules "IF t1 is far AND t2 is tall THEN consequent", Eqs. (7.10), (7.11), (7.29).

    sets: for each input the labels with (centre, width) of mu(x) = exp(-(x - centre)^2 / width^2), Eq. (7.30).
    rules: one mapping input -> label a rule; an input that a rule does not name does not matter to it.
    weights: how much each rule counts [-], 0 or more; None: all alike.
    """

    def __init__(
        self,
        sets: Mapping[str, Mapping[str, Sequence[float]]],
        rules: Sequence[Mapping[str, str]],
        weights: Sequence[float] | None = None,
    ) -> None:
        self.sets = {name: {label: tuple(pair) for label, pair in labels.items()} for name, labels in sets.items()}
        self.rules, self.weights = [dict(rule) for rule in rules], weights
        if weights is not None and (len(weights) != len(self.rules) or min(weights) < 0 or not any(weights)):
            raise ValueError(f"weights = {weights} is not allowed: it must be {len(self.rules)} numbers, 0 or more")
        for rule in self.rules:
            for name, label in rule.items():
                if label not in self.sets.get(name, {}):
                    raise ValueError(f"a rule says '{name} is {label}', but no such fuzzy set is defined")

    def strengths(self, **inputs: ArrayLike) -> Array:
        """Normalised firing strengths (..., rules) for inputs of common shape (...); they sum to 1.

        They are formed from logarithms, so that an input far outside every set still selects the nearest rule.
        """
        values = {name: np.asarray(value, float) for name, value in inputs.items()}
        shape = np.broadcast_shapes(*(value.shape for value in values.values()))
        exponents = np.zeros((*shape, len(self.rules)))
        if self.weights is not None:
            with np.errstate(divide="ignore"):  # a rule that does not count
                exponents += np.log(self.weights)
        for column, rule in enumerate(self.rules):
            for name, label in rule.items():
                centre, width = self.sets[name][label]
                exponents[..., column] -= ((values[name] - centre) / width) ** 2
        firing = np.exp(exponents - exponents.max(axis=-1, keepdims=True))
        return firing / firing.sum(axis=-1, keepdims=True)

    def blend(self, consequents: ArrayLike, **inputs: ArrayLike) -> Array:
        """Output (..., *output) for the rules' ``consequents`` (rules, *output), Eqs. (7.31), (7.35)."""
        return np.tensordot(self.strengths(**inputs), np.asarray(consequents, float), axes=1)

    def rescaled(self, name: str, factor: float) -> FuzzySystem:
        """The same rules, the sets of one input stretched by ``factor`` for a task of another size (Sect. 7.3.2)."""
        stretched = {label: (factor * centre, factor * width) for label, (centre, width) in self.sets[name].items()}
        return FuzzySystem({**self.sets, name: stretched}, self.rules, self.weights)
