# SPDX-License-Identifier: MIT
"""How objects show themselves, and what their functions have in common."""

import html
import os


class Presented:
    """An object that says what it is in a line, and in a notebook as a table."""

    def _facts(self):
        """Pairs of a name and a value; the first value is a title."""
        raise NotImplementedError

    def __repr__(self):
        facts = self._facts()
        rest = ", ".join(f"{name} {value}" for name, value in facts[1:])
        return f"<{type(self).__name__} {facts[0][1]}: {rest}>"

    def _repr_html_(self):
        rows = "".join(
            f"<tr><th style='text-align:left'>{html.escape(str(name))}</th>"
            f"<td style='text-align:left'>{html.escape(str(value))}</td></tr>"
            for name, value in self._facts())
        return f"<table><caption>{html.escape(type(self).__name__)}</caption>{rows}</table>"


def path_text(path):
    """A path as the compiled part takes it."""
    return os.fsdecode(os.fspath(path))


def given(**options):
    """The options that are there."""
    return {name: value for name, value in options.items() if value is not None and value is not False}
