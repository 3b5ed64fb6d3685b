"""One self-contained page: titled sections of text, tables and figures."""

import base64
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
from itertools import zip_longest
from pathlib import Path

from odometry.io.files import atomic_write

LONGEST_NUMBER = 40  # letters of a cell; longer ones are sentences
MANY_COLUMNS = 8  # more of them are printed in smaller letters
_CSS = """
:root { color-scheme: light dark; }
body { font: 16px/1.5 system-ui, sans-serif; max-width: 60rem; margin: 0 auto; padding: 1rem; }
h1 { font-size: 1.5rem; line-height: 1.25; }
h2 { font-size: 1.15rem; margin-top: 2.2rem; border-bottom: 1px solid #8886; }
h1, h2, p, li, figcaption, caption { overflow-wrap: anywhere; }
.lead { font-size: 1.1rem; }
figure { margin: 1rem 0; }
figure .scroll { margin: 0; }
figure img { display: block; max-width: 100%; height: auto; background: #fff; border-radius: 6px; }
figcaption, .note { font-size: .9rem; opacity: .85; }
.scroll { overflow-x: auto; margin: 1rem 0; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
caption { text-align: left; font-size: .9rem; opacity: .85; padding-bottom: .3rem; }
th, td { padding: .25rem .7rem; border-bottom: 1px solid #8884; text-align: right; }
th:first-child, td:first-child { text-align: left; padding-left: 0; }
thead th { vertical-align: bottom; }
th.words, td.words { text-align: left; }
tbody th { min-width: 7.5rem; }
@media screen and (max-width: 45rem) {
  figure img { max-width: none; width: calc(var(--width) / 2); }
  th, td { padding: .25rem .4rem; }
  td { white-space: nowrap; }
  td.words { white-space: normal; min-width: 15rem; }
  caption { max-width: calc(100vw - 2rem); }
}
@page { size: A4; margin: 1cm; }
@media print {
  :root { color-scheme: light; }
  body { max-width: none; padding: 0; font-size: 11pt; }
  .scroll { overflow-x: visible; }
  table { max-width: 100%; font-size: 8pt; }
  th, td { padding: .15rem .3rem; overflow-wrap: break-word; }
  tbody th { min-width: 0; }
  table.wide { font-size: 7pt; }
  table.wide th, table.wide td { overflow-wrap: anywhere; }
  h2 { break-after: avoid; }
  figure, tr, caption { break-inside: avoid; }
  figure img { max-height: 22cm; width: auto; }
}
"""


@dataclass(frozen=True)
class Paragraph:
    """Plain text."""

    text: str

    def html(self) -> str:
        """The element."""
        return f"<p>{escape(self.text)}</p>"


@dataclass(frozen=True)
class Listing:
    """A list of plain sentences."""

    items: Sequence[str]

    def html(self) -> str:
        """The element."""
        return "<ul>" + "".join(f"<li>{escape(item)}</li>" for item in self.items) + "</ul>"


@dataclass(frozen=True)
class Grid:
    """A table of plain text; the first column names its row.

    `links` are addresses of pages by the text of the first column.
    """

    header: Sequence[str]
    rows: Sequence[Sequence[str]]
    caption: str = ""
    links: Mapping[str, str] = field(default_factory=dict)

    def html(self) -> str:
        """The element."""
        marks = [_mark(column) for column in zip_longest(*self.rows, fillvalue="")]
        columns = zip_longest(self.header, marks, fillvalue="")
        head = "".join(f'<th scope="col"{mark}>{escape(name)}</th>' for name, mark in columns)
        body = "".join(_row(row, self.links, marks) for row in self.rows)
        caption = f"<caption>{escape(self.caption)}</caption>" if self.caption else ""
        wide = ' class="wide"' if len(self.header) > MANY_COLUMNS else ""
        return (
            f'<div class="scroll"><table{wide}>{caption}<thead><tr>{head}</tr></thead>'
            f"<tbody>{body}</tbody></table></div>"
        )


@dataclass(frozen=True)
class Picture:
    """A PNG file, taken into the page.

    Attributes
    ----------
    file : Path
    alt : str
        A description of it, for readers who cannot see it.
    caption : str
    """

    file: Path
    alt: str
    caption: str = ""

    def html(self) -> str:
        """The element."""
        png = self.file.read_bytes()
        data = base64.b64encode(png).decode("ascii")
        caption = f"<figcaption>{escape(self.caption)}</figcaption>" if self.caption else ""
        return (
            f'<figure><div class="scroll"><img alt="{escape(self.alt)}" '
            f'style="--width: {_width_px(png)}px" src="data:image/png;base64,{data}"></div>'
            f"{caption}</figure>"
        )


@dataclass(frozen=True)
class Section:
    """A title and its blocks."""

    title: str
    blocks: Sequence[Paragraph | Listing | Grid | Picture]


def render_page(title: str, lead: str, sections: Sequence[Section]) -> str:
    """Put a page together: no script, nothing loaded, every text escaped.

    Parameters
    ----------
    title : str
    lead : str
        The main sentence of the page; none where the first section has it.
    sections : sequence of Section
        Those without blocks are left out.
    """
    parts = [
        f"<section><h2>{escape(section.title)}</h2>\n"
        + "\n".join(block.html() for block in section.blocks)
        + "</section>"
        for section in sections
        if section.blocks
    ]
    name = escape(title)
    return "\n".join(
        [
            '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            '<meta http-equiv="Content-Security-Policy" '
            "content=\"default-src 'none'; img-src data:; style-src 'unsafe-inline'\">",
            f"<title>{name}</title>\n<style>{_CSS}</style>\n</head>\n<body>\n<main>",
            f"<h1>{name}</h1>",
            *([f'<p class="lead">{escape(lead)}</p>'] if lead else []),
            *parts,
            "</main>\n</body>\n</html>\n",
        ]
    )


def write_page(file: Path, title: str, lead: str, sections: Sequence[Section]) -> Path:
    """Write `render_page`; letters that UTF-8 cannot hold become question marks."""
    with atomic_write(file) as part:
        part.write_bytes(render_page(title, lead, sections).encode("utf-8", "replace"))
    return file


def _row(row: Sequence[str], links: Mapping[str, str], marks: Sequence[str]) -> str:
    first, *others = row
    name = escape(first)
    if first in links:
        name = f'<a href="{escape(links[first])}">{name}</a>'
    cells = "".join(
        f"<td{mark}>{escape(cell)}</td>" for cell, mark in zip(others, marks[1:], strict=False)
    )
    return f'<tr><th scope="row">{name}</th>{cells}</tr>'


def _mark(cells: Sequence[str]) -> str:
    """The class of a column: sentences begin on one line, numbers end on one."""
    return ' class="words"' if max(map(len, cells)) > LONGEST_NUMBER else ""


def _width_px(png: bytes) -> int:
    """The width in the first chunk of a PNG file (ISO/IEC 15948, 11.2.2)."""
    return int.from_bytes(png[16:20], "big")
