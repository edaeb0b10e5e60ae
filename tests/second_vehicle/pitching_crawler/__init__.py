"""A vehicle that leans to push: coplanar rotors, a sprung arm with a driven wheel, a foot.

It is a package of its own with the rows of ``entry_points.txt``. Those of the schema are loaded
while inspect's registries are built, so that nothing may be imported here.
"""
