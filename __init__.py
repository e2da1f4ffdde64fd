"""Southwell: are these natural frequencies of a rotating blade right?"""
