# SPDX-License-Identifier: MIT
"""link_pages.py LIST FILE.md: the file as Doxygen is to read it. A link to a folder becomes one to its page; what has no page, by the LIST of
all (one path a line), is no link; titles are plain text, as Doxygen shows their markup in its list of pages."""
import pathlib
import re
import sys

pages = set(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8").splitlines())
file = pathlib.Path(sys.argv[2]).resolve()


def link(match):
    text, target = match.groups()
    if "://" in target:
        return match[0]
    path = (file.parent / target.partition("#")[0]).resolve()
    page = path / "README.md" if path.is_dir() else path
    return f"[{text}]({page})" if str(page) in pages else text


text = re.sub(r"^# .*", lambda title: title[0].replace("`", ""), file.read_text(encoding="utf-8"))
# Every second part is a fenced block.
parts = re.split(r"(^```.*?^```$)", text, flags=re.M | re.S)
parts[::2] = [re.sub(r"(?<!!)\[([^\[\]]+)\]\(([^()\s]+)\)", link, part) for part in parts[::2]]
sys.stdout.reconfigure(encoding="utf-8", newline="\n")
sys.stdout.write("".join(parts))
