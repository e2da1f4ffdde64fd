"""Laws that every correct linearisation obeys, each checked without a model of the turbine."""
