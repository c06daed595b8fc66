"""Incremental movement primitives (IDMP): new features beside old kernels, for one new skill or for several styles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal, NamedTuple, TypedDict, Unpack

import numpy as np
from scipy.special import expit

from dexrepro.arrays import Array

from .demonstration import Demonstration
from .dmp import DMP, forcing_target
from .kernels import FeatureMap, GaussianKernels, phase
from .pseudo_inverse import extended_pseudo_inverse
from .regression import least_squares


class Blocks(NamedTuple):
    """Parts of the extended feature vector at N phases, Eq. (5.21).

    kernels: Psi (N, n); share: 1 / Gamma = sum phi / (sum phi + sum eta), (N, 1), between 0 and 1;
    enhancement: Upsilon (N, m), gamma_j = s eta_j / sum eta.
    """

    kernels: Array
    share: Array
    enhancement: Array

    @property
    def change(self) -> Array:
        """[(1/Gamma - 1) Psi | (1 - 1/Gamma) Upsilon], (N, n + m): what the new weights multiply."""
        return np.concatenate([(self.share - 1) * self.kernels, (1 - self.share) * self.enhancement], axis=1)


@dataclass(frozen=True)
class ExtendedKernels:
    """Features of an IDMP: those of the old skill, then the changes (1/Gamma - 1) Psi and (1 - 1/Gamma) Upsilon.

    kernels: the n initial kernels; input_weights, biases: W_e (n, m) and beta_e (m,) of the random features
    eta = sigmoid(phi W_e + beta_e), Eq. (5.11); base: features of the old skill, the kernels themselves unless the old
    skill is an IDMP already. Weights are stacked alike: [theta; theta_C; theta_U].
    """

    kernels: GaussianKernels
    input_weights: Array
    biases: Array
    base: FeatureMap

    @classmethod
    def draw(
        cls,
        kernels: GaussianKernels,
        count: int,
        rng: np.random.Generator,
        weight_std: float = 1.0,
        bias_range: float = 1.0,
        base: FeatureMap | None = None,
    ) -> ExtendedKernels:
        """``count`` random features, drawn one by one, so that more features begin with the same ones."""
        biases, weights = np.empty(count), np.empty((kernels.count, count))
        for j in range(count):
            weights[:, j] = weight_std * rng.standard_normal(kernels.count)
            biases[j] = rng.uniform(-bias_range, bias_range)
        return cls(kernels, weights, biases, kernels if base is None else base)

    def first(self, count: int) -> ExtendedKernels:
        """The same with the first ``count`` of its m random features alone."""
        return replace(self, input_weights=self.input_weights[:, :count], biases=self.biases[:count])

    @property
    def added(self) -> int:
        """Number m of random features."""
        return len(self.biases)

    @property
    def count(self) -> int:
        """Number of features p: those of the old skill, its copies and the new ones."""
        return self.base.count + self.kernels.count + self.added

    def blocks(self, phases: Array) -> Blocks:
        """Psi (N, n), 1/Gamma (N, 1) and Upsilon (N, m); Gamma itself would overflow where every kernel underflows."""
        activations = self.kernels.activations(phases)
        eta = expit(activations @ self.input_weights + self.biases)
        old, new = activations.sum(axis=1, keepdims=True), eta.sum(axis=1, keepdims=True)
        if not self.added:
            return Blocks(self.kernels.features(phases), np.ones_like(old), eta)
        return Blocks(self.kernels.features(phases), old / (old + new), phases[:, None] * eta / new)

    def features(self, phases: Array) -> Array:
        """[old features | (1/Gamma - 1) Psi | (1 - 1/Gamma) Upsilon], (N, count)."""
        return np.concatenate([self.base.features(phases), self.blocks(phases).change], axis=1)


class Options(TypedDict, total=False):
    """What :func:`extend_styles` takes beside primitive, features and demonstrations."""

    relearn_old: bool
    rest: float
    rcond: float
    ridge: float
    update: Literal["exact", "printed_start", "row_wise", "scalar"]


def extend_styles(
    primitive: DMP,
    features: ExtendedKernels,
    demonstrations: Sequence[Demonstration],
    relearn_old: bool = True,
    rest: float = 0.0,
    rcond: float = 1e-10,
    ridge: float = 0.0,
    update: Literal["exact", "printed_start", "row_wise", "scalar"] = "exact",
) -> list[DMP]:
    """Learn several new skills on shared features from one old skill, by one least-squares problem; Eqs. (5.26)-(5.29).

    The weights of the old skill stay inside the new ones. relearn_old: fit theta_C and theta_U; otherwise theta_U
    alone, which changes the skill gradually as features are added. rest, rcond, ridge: as for ``DMP.fit``. update:
    exact least squares of Delta f, or, for theta_C and theta_U together, one of the readings of ``lemma_weights``.
    """
    if primitive.features is not features.base:
        raise ValueError("the features must extend those of the old skill: give them as base")
    targets = [_change_target(primitive, demonstration, rest) for demonstration in demonstrations]
    phases = targets[0][0]
    blocks, wanted = features.blocks(phases), np.concatenate([target for _, target in targets], axis=1)
    skip = 0 if relearn_old else features.kernels.count
    if update == "exact":
        solved = least_squares(blocks.change[:, skip:], wanted, rcond, ridge)
    else:
        solved = lemma_weights(blocks, wanted, update, rcond)
    dimensions = primitive.weights.shape[1]
    frozen = np.zeros((skip, dimensions))
    return [
        replace(
            primitive,
            features=features,
            weights=np.concatenate([primitive.weights, frozen, solved[:, k * dimensions : (k + 1) * dimensions]]),
            start=demonstration.start,
            goal=demonstration.goal,
        )
        for k, demonstration in enumerate(demonstrations)
    ]


def lemma_weights(
    blocks: Blocks, target: Array, reading: Literal["printed_start", "row_wise", "scalar"], rcond: float = 1e-10
) -> Array:
    """theta_C and theta_U (n + m, k) as Eqs. (5.24), (5.29) have them: the lemma with A = Psi and a = -Upsilon.

    Gamma / (1 - Gamma) stands before Delta f: sample by sample ("row_wise"; this minimises a weighted residual), or as
    one number, its mean ("scalar"). theta_C starts from Psi^+ [Gamma / (1 - Gamma) Delta f]; the print leaves the
    factor, which is negative, out of it ("printed_start").
    """
    factor = 1 / (blocks.share - 1)
    scaled = (factor.mean() if reading == "scalar" else factor) * target
    inverse = np.asarray(np.linalg.pinv(blocks.kernels, rcond=rcond), float)
    start = inverse @ (target if reading == "printed_start" else scaled)
    extended = extended_pseudo_inverse(blocks.kernels, inverse, -blocks.enhancement)
    return np.concatenate([start - inverse @ scaled, np.zeros((blocks.enhancement.shape[1], target.shape[1]))]) + (
        extended @ scaled
    )


def extend(primitive: DMP, features: ExtendedKernels, demonstration: Demonstration, **options: Unpack[Options]) -> DMP:
    """Learn one new skill from an old one, Eqs. (5.19)-(5.24); options as for ``extend_styles``."""
    return extend_styles(primitive, features, [demonstration], **options)[0]


def original(primitive: DMP) -> DMP:
    """The old skill that an IDMP contains: theta_C = theta_U = 0."""
    features = primitive.features
    if not isinstance(features, ExtendedKernels):
        raise TypeError("this primitive was not extended")
    return replace(primitive, features=features.base, weights=primitive.weights[: features.base.count])


def interpolate(first: DMP, second: DMP, share: float) -> DMP:
    """Mix two styles on shared features: weights share theta_1 + (1 - share) theta_2; Eq. (5.30).

    Start, goal and initial velocity, of which (5.30) says nothing, are mixed alike. Where the amplitude is the same for
    both, the path is then the pointwise mixture of the two.
    """
    if first.features is not second.features:
        raise ValueError("only skills on shared features can be mixed by their weights")

    return replace(
        first,
        weights=share * first.weights + (1 - share) * second.weights,
        start=share * first.start + (1 - share) * second.start,
        goal=share * first.goal + (1 - share) * second.goal,
        velocity=share * first.velocity + (1 - share) * second.velocity,
    )


def _change_target(primitive: DMP, demonstration: Demonstration, rest: float) -> tuple[Array, Array]:
    """Phases and Delta f = f_target - f_old, Eq. (5.28)."""
    samples = demonstration.with_rest(rest) if rest > 0 else demonstration
    time = samples.time - samples.time[0]
    tau = primitive.time_constant
    target = forcing_target(samples, primitive.system, tau, samples.goal)
    target = target / primitive.scaling.amplitude(samples.start, samples.goal)
    return phase(time, tau, primitive.decay), target - primitive.forcing(time)
