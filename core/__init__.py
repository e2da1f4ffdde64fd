"""The language (Blade, Modes) and the in-house solver; imports nothing of ours."""
