"""What joins a law to a comparison: its kind, what it needs, what it reports."""

from functools import partial

import numpy as np
import pytest

from dexrepro.control.contract import (
    Measured,
    Plain,
    Undefined,
    Unusable,
    build,
    channels,
    check,
    coriolis,
    is_plain,
    memory,
    number,
    printed_forms,
    report,
)
from dexrepro.robots.planar import PlanarChain


class Declared:
    kind = "joint"

    def __call__(self, measured, desired): ...


class Learning(Declared):
    needs = ("model", "network")

    def __init__(self, model, network=None):
        self.model, self.network = model, network

    def diagnostics(self):
        return {"nodes": 3.0}


class Model:
    """A planar arm in a vertical plane."""

    chain = PlanarChain((0.5, 0.3, 0.1), (1.5, 0.9, 0.2))

    def gravity(self, q):
        return np.array(self.chain.gravity(q))

    def bias(self, q, dq):
        return np.array(self.chain.torque(q, dq, np.zeros(3))) + self.gravity(q)


def test_a_law_takes_what_it_needs_of_what_is_offered_and_keeps_what_it_was_given():
    law = build(partial(Learning, network="own"), model="arm", network="offered", stiffness=3.0)
    assert (law.model, law.network) == ("arm", "own")
    assert build(law, model="another") is law
    with pytest.raises(ValueError, match=r"Learning: .*model.*; this comparison offers stiffness"):
        build(partial(Learning), stiffness=3.0)


def test_a_law_of_another_kind_or_of_none_is_refused():
    law = Declared()
    assert check(law, "joint") is law
    with pytest.raises(ValueError, match="Declared is of kind 'joint'; here a law of kind 'holding' is wanted"):
        check(law, "holding")
    with pytest.raises(ValueError, match="object is no law: its class must declare kind = 'joint'"):
        check(object(), "joint")


class Simple:
    """A holding law of the plain shape; its parameters have names that say nothing."""

    def reset(self, a):
        self.told = [a]

    def __call__(self, a, b):
        self.told += [a, b]
        return a - 0.1 * b

    def diagnostics(self):
        return {"calls": float(len(self.told))}


def made(**methods):
    """A class with some methods of the plain law changed, or left out by None."""
    body = {name: value for name, value in vars(Simple).items() if not name.startswith("__")}
    body |= {"__call__": Simple.__call__} | methods
    return type("Made", (), {name: value for name, value in body.items() if value is not None})


def test_a_plain_holding_law_is_told_position_and_force_and_keeps_its_diagnostics():
    law = Simple()
    adapter = check(law, "holding")
    assert isinstance(adapter, Plain)
    adapter.reset(Measured(0.0, 0.3, 0.0, 5.0))
    assert adapter(Measured(0.1, 0.4, 9.0, 2.0)) == pytest.approx(0.2)
    assert law.told == [0.3, 0.4, 2.0]
    assert report(adapter) == report(law) == {"calls": 3.0}
    assert check(build(partial(Simple), model="arm"), "holding").law.__class__ is Simple


@pytest.mark.parametrize("kind", ["joint", "end_point"])
def test_only_a_holding_law_may_be_plain(kind):
    with pytest.raises(ValueError, match=f"Simple is no law: its class must declare kind = '{kind}' .*holding.$"):
        check(Simple(), kind)


@pytest.mark.parametrize(
    "law",
    [
        made(__call__=lambda self, measured: 0.0),
        made(__call__=lambda self, measured, target=None: 0.0),
        made(__call__=lambda self, position, force, dt: 0.0),
        made(__call__=lambda self, *arguments: 0.0),
        made(__call__=lambda self, *, position, force: 0.0),
        made(__call__=None),
        made(reset=lambda self: None),
        made(reset=None),
        made(kind="hold"),
        partial,
    ],
)
def test_what_cannot_be_called_as_a_plain_law_or_as_another_too_must_declare_its_kind(law):
    assert not is_plain(law)
    instance = partial(Simple) if law is partial else law()
    sentence = (
        "is no law: its class must declare kind = 'holding' .*; or, without a kind, have reset.self, position. and"
    )
    with pytest.raises(ValueError, match=sentence):
        check(instance, "holding")


def test_defaults_and_names_of_a_plain_law_are_free():
    assert is_plain(made(__call__=lambda self, x, f, verbose=False: x, reset=lambda self, x=0.0: None))


def test_printed_forms_are_a_list_of_known_words():
    assert printed_forms(["sign"], ("sign", "gain")) == {"sign"}
    assert printed_forms([], ("sign",)) == frozenset()
    for wrong in ("sign", ["sine"], ["sign", "sine"]):
        with pytest.raises(ValueError, match="must be a list of sign, gain"):
            printed_forms(wrong, ("sign", "gain"))


def test_only_what_a_law_reports_becomes_a_channel():
    law = Learning("arm", network="memory")
    assert report(Declared()) == {}
    probes = channels(law, "nodes", "estimate")
    assert {name: probe() for name, probe in probes.items()} == {"nodes": 3.0}
    assert (memory(law), memory(partial(Learning, network="open")), memory(Declared())) == ("memory", "open", None)


def test_coriolis_terms_come_from_inverse_dynamics_alone():
    """C(q, u) v is linear in both and symmetric, and C(q, u) u is what bias has beside gravity."""
    model, rng = Model(), np.random.default_rng(0)
    q, u, v, w = rng.normal(size=(4, 3))
    assert coriolis(model, q, u, u) == pytest.approx(model.bias(q, u) - model.gravity(q))
    assert coriolis(model, q, u, v) == pytest.approx(coriolis(model, q, v, u))
    both = coriolis(model, q, u, v) + 2.0 * coriolis(model, q, u, w)
    assert coriolis(model, q, u, v + 2.0 * w) == pytest.approx(both)


def test_one_finite_number_in_whatever_shape_is_a_number():
    for value in (2, 2.0, np.float32(2.0), np.array(2.0), np.array([[2.0]])):
        assert number(value) == 2.0
    for value in ("2", None, [2.0], np.zeros(0), np.ones(2)):
        with pytest.raises(Unusable, match="one number is wanted"):
            number(value)
    for value in (np.nan, np.array([-np.inf])):
        with pytest.raises(Undefined, match="a finite number is wanted"):
            number(value)
