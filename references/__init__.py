"""Answers from elsewhere: one module per foreign code or closed form; imports core."""
