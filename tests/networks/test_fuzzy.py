import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dexrepro.networks.fuzzy import FuzzySystem

SETS = {
    "distance": {"close": (5.8, 3.6), "far": (11.8, 3.6)},
    "height": {"low": (2.0, 3.6), "tall": (8.0, 3.6)},
    "direction": {"left": (0.0, 0.48), "forward": (0.8, 0.3), "right": (1.0, 0.12)},
}
RULES = [dict(zip(SETS, labels)) for labels in itertools.product(*SETS.values())]
SYSTEM = FuzzySystem(SETS, RULES)
INPUTS = {"distance": st.floats(-500, 800), "height": st.floats(-20, 40), "direction": st.floats(-5, 5)}


@given(st.fixed_dictionaries(INPUTS))
@settings(deadline=None, max_examples=50)
def test_strengths_are_a_partition_of_one_however_far_the_input(inputs):
    strengths = SYSTEM.strengths(**inputs)
    assert strengths.shape == (12,)
    assert (strengths >= 0).all()
    assert strengths.sum() == pytest.approx(1.0)


def test_strengths_are_the_normalised_products_of_memberships():
    x = {"distance": 9.0, "height": 4.0, "direction": 0.4}
    products = [
        np.prod(
            [np.exp(-(((x[name] - SETS[name][label][0]) / SETS[name][label][1]) ** 2)) for name, label in rule.items()]
        )
        for rule in RULES
    ]
    assert SYSTEM.strengths(**x) == pytest.approx(np.array(products) / np.sum(products))


@given(st.fixed_dictionaries(INPUTS))
@settings(deadline=None, max_examples=30)
def test_output_stays_in_the_hull_of_the_consequents(inputs):
    consequents = np.random.default_rng(0).normal(size=(12, 5))
    output = SYSTEM.blend(consequents, **inputs)
    assert (output <= consequents.max(axis=0) + 1e-12).all()
    assert (output >= consequents.min(axis=0) - 1e-12).all()


def test_blending_weights_equals_blending_what_they_produce():
    rng = np.random.default_rng(1)
    features, weights = rng.normal(size=(30, 7)), rng.normal(size=(12, 7))
    x = {"distance": 8.0, "height": 5.0, "direction": 0.6}
    assert features @ SYSTEM.blend(weights, **x) == pytest.approx(SYSTEM.blend(weights @ features.T, **x))


def test_narrow_sets_return_the_rule_at_its_own_condition():
    narrow = FuzzySystem(
        {name: {label: (c, 0.25 * w) for label, (c, w) in labels.items()} for name, labels in SETS.items()}, RULES
    )
    at_rule = narrow.strengths(distance=11.8, height=8.0, direction=0.0)
    assert at_rule.max() > 0.999


def test_rescaling_an_input_and_its_sets_together_changes_nothing():
    x = {"distance": 8.0, "height": 5.0, "direction": 0.6}
    scaled = SYSTEM.rescaled("distance", 0.7).strengths(**{**x, "distance": 0.7 * 8.0})
    assert scaled == pytest.approx(SYSTEM.strengths(**x))


def test_inputs_broadcast():
    assert SYSTEM.strengths(distance=np.zeros((4, 1)), height=5.0, direction=np.zeros(3)).shape == (4, 3, 12)


def test_a_rule_about_an_unknown_set_is_refused():
    with pytest.raises(ValueError, match="height is huge"):
        FuzzySystem(SETS, [{"height": "huge"}])


def test_weights_of_rules_shift_the_blend_and_equal_ones_do_not():
    x = {"distance": 9.0, "height": 4.0, "direction": 0.4}
    weights = np.arange(12.0)
    plain, weighted = (FuzzySystem(SETS, RULES, given).strengths(**x) for given in (None, weights.tolist()))
    assert weighted == pytest.approx(weights * plain / (weights @ plain))
    assert FuzzySystem(SETS, RULES, [3.0] * 12).strengths(**x) == pytest.approx(plain)
    last = FuzzySystem(SETS, RULES, [0.0] * 11 + [1.0]).rescaled("distance", 2.0)
    far = last.strengths(distance=-900, height=0, direction=0)
    assert far[-1] == 1.0
    for wrong in ([1.0], [-1.0] * 12, [0.0] * 12):
        with pytest.raises(ValueError, match="is not allowed: it must be 12 numbers, 0 or more"):
            FuzzySystem(SETS, RULES, wrong)
