"""What is exported, once, in the few words of Python that every language has.

A program is functions over numbers and arrays of numbers, with every variable declared where it
begins, as :mod:`puck_tables.export.translate` reads them.
"""
