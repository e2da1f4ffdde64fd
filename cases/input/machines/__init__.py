"""Files of towers and whole turbines, of any format."""
