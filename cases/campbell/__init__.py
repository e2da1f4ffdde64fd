"""The Campbell diagram of a blade: modes tracked along rotor speed, margins and encounters."""
