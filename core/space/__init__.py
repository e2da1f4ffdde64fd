"""Rigid-body motions: poses (SE(3)), twists and wrenches.

``rigid`` holds the compiled loops for one motion at a time, ``spatial`` applies them to batches of arrays. Everything above
takes poses (4, 4) and twists (6,) from here; nothing here knows of bodies or beams.
"""
