"""The vocabulary of an experiment: what its configuration is, and in what a case differs from it."""

from __future__ import annotations

import pytest

from dexrepro.experiment import Config, changed


def test_a_configuration_key_is_an_attribute_and_a_wrong_one_is_named() -> None:
    config = Config.of({"a": {"b": [1, {"c": 2}]}})
    assert config.a.b[1].c == 2
    with pytest.raises(AttributeError, match="no configuration key 'x'; there are: a"):
        _ = config.x


def test_what_a_case_is_told_beside_its_configuration_is_no_change_of_it() -> None:
    shared = {"gain": 1.0, "law": {"rate": 2.0, "lag": 0.1}}
    told = {"case": "fast", "seed": 3, "perturbation": 0.0}
    assert changed({"gain": 1.0, "law": {"rate": 5.0, "lag": 0.1}, **told}, shared) == {"law.rate"}
