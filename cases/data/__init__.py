"""The cases, one TOML file each."""
