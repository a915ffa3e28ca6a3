# SPDX-License-Identifier: MIT
"""The options of the package's functions: those of the program, from one table in the compiled part."""

import difflib
import functools
import inspect

from . import _mmmconverter


def with_options(task):
    """Of a function with **options: what these are goes into its signature and its docstring."""
    table = _mmmconverter.options(task)

    def decorate(function):
        signature = inspect.signature(function)
        own = [one for one in signature.parameters.values() if one.kind is not one.VAR_KEYWORD]
        rows = [row for row in table if row[0] not in signature.parameters]
        options = [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None,
                                     annotation=f"Optional[{annotation}]")
                   for name, _, annotation, _ in rows]
        full = signature.replace(parameters=own + options)

        @functools.wraps(function)
        def checked(*arguments, **keywords):
            for name in keywords:
                if name not in full.parameters:
                    near = difflib.get_close_matches(name, full.parameters, 1)
                    raise TypeError(f"{function.__name__}() has no argument {name!r}" +
                                    (f"; did you mean {near[0]!r}?" if near else ""))
            full.bind(*arguments, **keywords)
            return function(*arguments, **keywords)

        described = "".join(f"    {name} : {words}, optional\n        {text[0].upper()}{text[1:]}.\n"
                            for name, words, _, text in rows)
        checked.__doc__ = function.__doc__.replace("    **options\n", described)
        checked.__signature__ = full
        return checked

    return decorate
