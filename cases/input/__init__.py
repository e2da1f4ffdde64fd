"""From a file to a case: schemas, blade files, mechanisms, and the error raised for invalid input.

A path or a name comes in; a ``Case``, a ``Blade`` or a mechanism goes out.
"""
