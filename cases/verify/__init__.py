"""The matrix run: every blade of every case solved by every code.

Cases come in; a ``Run`` of cells goes out. ``matrix`` plans and runs the columns, ``cells`` turns answers into rows.
"""
