"""What is asked: a request, its subjects, and the columns of each.

Names and files come in; subjects, their columns and their descriptions go out. Nothing is solved here.
"""
