"""One module an engine, each with what :class:`dexrepro.physics.engine.Engine` asks for."""
