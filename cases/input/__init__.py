"""From a file to a case: schemas, blade files, mechanisms, and the one error of bad input.

A path or a name comes in; a ``Case``, a ``Blade`` or a mechanism goes out.
"""
