"""What every foreign code offers, and how it is run.

``interface`` defines a code and ``registry`` finds one by name. ``worker`` runs it in a process of its own and exchanges the
blade and the modes as JSON (``wire``). ``quadratic`` and ``damped`` solve the eigenproblem for codes that return matrices.
"""
