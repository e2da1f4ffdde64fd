"""The interface of foreign codes, and how they are run.

``interface`` defines a code and ``registry`` finds one by name. ``worker`` runs it in a separate process and exchanges
the blade and the modes as JSON (``wire``).
"""
