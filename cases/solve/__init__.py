"""Solutions: Southwell's own solver is refined until it can serve as reference, and each code until it can be judged.

A column of the plan comes in; its cells go out.
"""
