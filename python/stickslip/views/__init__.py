"""What can be said and drawn of each kind of result: on a terminal, as a picture, in a report.

The view of a kind is a module with the functions of `stickslip.views.kinds.View`. They return
tables, rows and panels, and print nothing: command and report show the same.
"""
