"""The simulated world: engines, arms, bodies, contact, elastic objects, recorder, rendering."""
