"""The description of a mechanism: bodies, joints, motions, springs and loads."""
