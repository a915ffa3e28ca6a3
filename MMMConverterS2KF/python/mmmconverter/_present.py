# SPDX-License-Identifier: MIT
"""How objects show themselves, and what their functions have in common."""

import html
import os
import shutil
import tempfile
import weakref

import numpy as np

from ._mmmconverter import Error


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


class MissingFile(Error, FileNotFoundError):
    """A file that is not there."""


class WrongValue(Error, ValueError):
    """What an argument can't be."""


class Filed:
    """What other functions read from a file: the one where it is saved, or one for the time that it lives."""

    file = None
    _folder = None

    def _as_file(self):
        if self.file is not None:
            return self.file
        if self._folder is None:
            self._folder = tempfile.mkdtemp()
            weakref.finalize(self, shutil.rmtree, self._folder, ignore_errors=True)
            self._write(os.path.join(self._folder, "saved.xml"))
        return os.path.join(self._folder, "saved.xml")


def of_raw(name):
    """A property that the compiled part has."""
    return property(lambda self: getattr(self._raw, name))


class Kept:
    """What the compiled part had, of an object that was pickled or copied."""

    def __init__(self, values):
        self.__dict__.update(values)

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        raise WrongValue(f"{name}: a copy has the numbers alone; do this before it is copied or pickled")


def input_text(path):
    """The path of a file to read, as the compiled part takes it."""
    text = path_text(path)
    if not os.path.exists(text):
        raise MissingFile(f"{text}: no such file")
    return text


LARGEST_EXTENT = 50  # [m] of the markers of a frame


def in_metres(markers):
    """The markers, (frames, labels, 3) or (labels, 3). They are metres, or this says what they seem to be."""
    places = np.asarray(markers, dtype=float)
    if places.ndim < 2 or not np.isfinite(places).any():
        return markers
    seen = np.isfinite(places)
    high = np.where(seen, places, -np.inf).max(axis=-2)
    low = np.where(seen, places, np.inf).min(axis=-2)
    extents = (high - low).max(axis=-1)
    extents = extents[np.isfinite(extents)]
    if extents.size > 0 and np.median(extents) > LARGEST_EXTENT:
        raise WrongValue(f"markers: those of a frame are {np.median(extents):.0f} m apart; positions are metres: "
                         "are these millimetres (divide by 1000)?")
    return markers


def path_text(path):
    """A path as the compiled part takes it."""
    return os.fsdecode(os.fspath(path))


def given(**options):
    """The options that are there."""
    return {name: value for name, value in options.items() if value is not None and value is not False}
