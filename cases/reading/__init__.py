"""The second reading of a blade's file: another parser, another conversion, compared station by station."""
