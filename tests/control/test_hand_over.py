import pytest

from dexrepro.control.hand_over import ContactLatch


def test_a_single_spike_is_no_contact_and_a_short_loss_is_no_release():
    latch = ContactLatch(threshold=1.0, samples=3, release=0.2, release_samples=5)
    assert [latch(f) for f in (0.0, 5.0, 0.0, 1.5, 1.5, 1.5)] == [False] * 5 + [True]
    assert all(latch(f) for f in (0.0, 0.0, 0.0, 0.0, 0.9, 0.0))
    assert [latch(0.0) for _ in range(4)] == [True, True, True, False]
    assert latch.switches == 2


def test_a_bare_comparison_chatters():
    bare = ContactLatch(threshold=1.0, samples=1, release=1.0, release_samples=1)
    for k in range(10):
        bare(0.9 if k % 2 else 1.1)
    assert bare.switches == 10


def test_a_latch_must_open_below_where_it_closes():
    with pytest.raises(ValueError, match="above"):
        ContactLatch(threshold=1.0, samples=1, release=2.0, release_samples=1)
