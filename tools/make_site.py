#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the documents into a site that needs no network: build/release/site/html/index.html.

    tools/make_site.py PETZVAL OUTPUT_FOLDER [--api FOLDER]

PETZVAL is the program, whose help becomes a page. Needs Sphinx, MyST and the theme Furo (Debian: python3-sphinx
python3-myst-parser furo). Exits with 77 where they are missing, and with 1 for a link that leads nowhere.
"""

import argparse
import pathlib
import re
import shutil
import subprocess
import sys

PROJECT = pathlib.Path(__file__).resolve().parent.parent
CONFIGURATION = """project = "Petzval"
author = "The Petzval authors"
version = release = {version!r}
extensions = ["myst_parser"]
html_theme = "furo"
html_title = "Petzval {version}"
html_show_copyright = False
html_show_sphinx = False
html_extra_path = {extra!r}
myst_heading_anchors = 4
highlight_language = "none"
suppress_warnings = ["misc.highlighting_failure"]
"""


def own_links(text, pages):
    """Links to pages stay; those to other files of the project become their names."""
    def link(match):
        words, target = match.groups()
        if re.match(r"[a-z]+:|#|pictures/", target):
            return match.group(0)
        path, anchor = (target.split("#") + [""])[:2]
        name = path.removeprefix("docs/").removeprefix("../")
        name = "START.md" if name == "README.md" else name
        if name in pages:
            return f"[{words}]({name}{'#' + anchor if anchor else ''})"
        return words if words.startswith("`") else f"`{words}`"

    return re.sub(r"(?<!!)\[([^\]]*)\]\(([^)\s]+)\)", link, text)


def commands_page(program):
    """What `petzval --help-all` and the help of every command say."""
    def says(*words):
        return subprocess.run([program, *words], capture_output=True, text=True, check=True).stdout

    def commands_of(text):
        listed = re.split(r"\n(?:Sub)?[Cc]ommands:\n", text)
        return re.findall(r"^  ([a-z][a-z0-9-]*)(?:,\S+)?\s", listed[1], re.MULTILINE) if len(listed) > 1 else []

    lines = ["# Commands", "", "What every command says of itself with `--help-all`.", ""]

    def add(words, depth):
        text = says(*words, "--help-all")
        lines.extend([f"{'#' * depth} petzval {' '.join(words)}".rstrip(), "", "```text", text.rstrip(), "```", ""])
        for name in commands_of(text):
            add([*words, name], min(depth + 1, 4))

    add([], 2)
    return "\n".join(lines)


def write_sources(folder, program):
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    shutil.copytree(PROJECT / "docs/pictures", folder / "pictures")
    texts = {page.name: page.read_text() for page in (PROJECT / "docs").glob("*.md")}
    texts["START.md"] = re.sub(r"^# Petzval$", "# First steps", (PROJECT / "README.md").read_text(), flags=re.MULTILINE)
    texts["START.md"] = texts["START.md"].replace("](docs/pictures/", "](pictures/")
    texts["COMMANDS.md"] = commands_page(program)
    for name, text in texts.items():
        (folder / name).write_text(own_links(text, texts))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--api", type=pathlib.Path, help="pages of the C++ interface, to be put in")
    options = parser.parse_args()
    try:
        import furo  # noqa: F401
        import myst_parser  # noqa: F401
        import sphinx  # noqa: F401
    except ImportError as missing:
        print(f"{missing.name} is missing; Debian's python3-sphinx, python3-myst-parser and furo would do")
        return 77
    sources = options.output / "source"
    write_sources(sources, options.program.resolve())
    version = re.search(r"project\(petzval VERSION (\S+)", (PROJECT / "CMakeLists.txt").read_text()).group(1)
    extra = []
    if options.api:
        shutil.copytree(options.api, sources / "cpp-reference" / "api")
        extra = ["cpp-reference"]
        with (sources / "CPP.md").open("a") as page:
            page.write("\n## Every class and function\n\n<a href=\"api/annotated.html\">Reference of the public headers</a>\n")
    (sources / "conf.py").write_text(CONFIGURATION.format(version=version, extra=extra))
    html = options.output / "html"
    shutil.rmtree(html, ignore_errors=True)
    return subprocess.run([sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-b", "html", sources, html]).returncode


if __name__ == "__main__":
    sys.exit(main())
