"""A crawler with eight rotors, a stiffer hinge, a larger wheel and modes of its own; no propping.

A package that builds on another: nothing of either may be imported here.
"""
