"""The plan of a run: the request, its subjects (blades, mechanisms, turbines) and the codes that solve each.

Names and files come in; subjects, their columns and their descriptions go out. Nothing is solved here.
"""
