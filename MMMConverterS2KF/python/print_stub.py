# SPDX-License-Identifier: MIT
"""python print_stub.py FOLDER: types of the options, of the compiled part in that folder, for programs that check types."""
import sys

sys.path.insert(0, sys.argv[1])
import _mmmconverter  # noqa: E402

print('''# SPDX-License-Identifier: MIT
import os
from typing import Any, Callable, Optional, Sequence, Tuple, TypedDict, TypeVar, Union

F = TypeVar("F", bound=Callable[..., Any])

def with_options(task: str) -> Callable[[F], F]: ...''')
for task in _mmmconverter.tasks():
    name = "".join(word.capitalize() for word in task.split("_"))
    print(f"\nclass {name}Options(TypedDict, total=False):")
    for keyword, _, annotation, _ in _mmmconverter.options(task):
        if (task, keyword) == ("read_model", "model"):  # its first argument
            continue
        print(f"    {keyword}: Optional[{annotation}]")
