"""Output for continuous integration: the gate's text, JUnit XML and the pytest plug-in."""
