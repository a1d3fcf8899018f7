# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The page: sections of text, figures and tables, with everything embedded."""

import base64
import functools
import io
import os
import re
from html import escape
from pathlib import Path

from matplotlib.mathtext import MathTextParser
from matplotlib.text import Text

import style

STYLE = (Path(__file__).parent / "page.css")


def write_page(target, html):
    """Writes a page as a whole: a reader finds the old one or the new one, never half of it."""
    partial = Path(f"{target}.partial")
    partial.write_text(html, encoding="utf-8")
    os.replace(partial, target)


class Page:
    """Collects the sections of the report and writes them as one self-contained file."""

    def __init__(self, figure_directory=None):
        self.parts = []
        self.contents = []
        self.figure_directory = figure_directory and Path(figure_directory)
        if self.figure_directory:
            self.figure_directory.mkdir(parents=True, exist_ok=True)

    def add(self, html):
        """Appends ready HTML."""
        self.parts.append(html)

    def paragraph(self, text):
        """Appends text, which is escaped here, as a paragraph."""
        self.add(f"<p>{escape(text)}</p>")

    def section(self, title, mark, contents=True):
        """Starts a section."""
        if self.parts and mark != "problem":
            self.add("</section>")
        self.add(f'<section id="{mark}"><h2>{escape(title)}</h2>')
        if contents:
            self.contents.append((title, mark))

    def figure(self, figure, name, caption, vector=False, heading=None):
        """Embeds a figure, as SVG where it is lines and as PNG where it is pixels.

        caption and heading are text, which is escaped here."""
        data, kind = encode(figure, vector)
        if self.figure_directory:
            target = self.figure_directory / f"{name}.png"
            target.write_bytes(data if not vector else encode(figure, False)[0])
        width = int(figure.get_figwidth() * 100)
        uri = f"data:{kind};base64,{base64.b64encode(data).decode('ascii')}"
        title = f"<h3>{escape(heading)}</h3>" if heading else ""
        text = f"<figcaption>{escape(caption)}</figcaption>" if caption else ""
        self.add(f'<figure>{title}<img src="{uri}" width="{width}" '
                 f'alt="{escape(caption or heading or name, quote=True)}" />{text}</figure>')

    def html(self, title, header):
        """The whole document."""
        links = " ".join(f'<a href="#{mark}">{escape(t)}</a>' for t, mark in self.contents)
        body = "\n".join(self.parts)
        sheet = STYLE.read_text(encoding="utf-8")
        return (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8" />\n'
                f'<meta name="viewport" content="width=device-width, initial-scale=1" />\n'
                f"<title>{escape(title)}</title>\n<style>\n{sheet}</style></head>\n<body><main>\n"
                f"<header>{header}<nav>{links}</nav></header>\n{body}\n</section>\n"
                f"</main></body></html>\n")


@functools.lru_cache(maxsize=None)
def is_formula(text):
    """Whether matplotlib reads a text with dollar signs."""
    try:
        MathTextParser("path").parse(text)
        return True
    except ValueError:
        return False


def leave_dollars_alone(figure):
    """Texts of the user that are no formulas of matplotlib, though they have dollar signs, are drawn as they are."""
    for text in figure.findobj(Text):
        if "$" in text.get_text() and not is_formula(text.get_text()):
            text.set_parse_math(False)


def encode(figure, vector):
    """(bytes, media type) of a figure."""
    buffer = io.BytesIO()
    leave_dollars_alone(figure)
    if vector:
        figure.savefig(buffer, format="svg", metadata={"Date": None})
        return buffer.getvalue(), "image/svg+xml"
    # More compression takes half as long again for files that are 3 % smaller.
    figure.savefig(buffer, format="png", dpi=style.DOTS_PER_INCH, metadata={"Software": None}, pil_kwargs={"compress_level": 4})
    return buffer.getvalue(), "image/png"


def paragraphs(text):
    """Plain text as HTML paragraphs; blank lines separate them, indented lines are kept."""
    blocks = [b.strip("\n") for b in re.split(r"\n\s*\n", text or "") if b.strip()]
    html = []
    for block in blocks:
        lines = block.split("\n")
        if len(lines) > 1 and all(line.startswith("  ") for line in lines):
            html.append(f"<pre>{escape(block)}</pre>")
        else:
            html.append(f"<p>{escape(' '.join(line.strip() for line in lines))}</p>")
    return "\n".join(html)
