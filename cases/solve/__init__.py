"""The answers: core refined until it can serve as reference, and codes refined until they can be judged.

A column of the plan comes in; its cells go out.
"""
