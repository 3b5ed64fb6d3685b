"""The page, read back by the parser of the standard library."""

import base64
from html.parser import HTMLParser

import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.report.drawing.html import (
    Grid,
    Listing,
    Paragraph,
    Picture,
    Section,
    render_page,
    write_page,
)

NASTY = "<script>alert('x')</script> & \"more\""
PNG = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="
)


class Reader(HTMLParser):
    """Collects elements with their attributes, and the text of each."""

    VOID = frozenset({"meta", "img"})

    def __init__(self, page):
        super().__init__()
        self.elements, self.texts, self.open = [], [], []
        self.feed(page)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if data.strip():
            self.texts.append((self.open[-1], data.strip()))

    def named(self, tag):
        return [attributes for name, attributes in self.elements if name == tag]


@pytest.fixture
def picture(tmp_path):
    file = tmp_path / "a.png"
    file.write_bytes(PNG)
    return Picture(file, f"shows {NASTY}", NASTY)


@pytest.fixture
def page(picture):
    blocks = (
        Paragraph(NASTY),
        Listing([NASTY]),
        Grid((NASTY, "b"), [(NASTY, NASTY)], NASTY),
        picture,
    )
    return render_page(NASTY, NASTY, [Section(NASTY, blocks), Section("empty", ())])


def test_text_of_files_comes_out_as_text(page):
    read = Reader(page)
    assert read.open == []
    assert not read.named("script")
    said = [tag for tag, text in read.texts if text == NASTY]
    assert said == ["title", "h1", "p", "h2", "p", "li", "caption", "th", "th", "td", "figcaption"]


@given(st.text(st.characters(codec="utf-8", exclude_characters="\r\x00"), min_size=1))
def test_any_text_is_text_on_the_page(text):
    blocks = (Paragraph(text), Listing([text]), Grid((text,), [(text,)], text))
    read = Reader(render_page(text, text, [Section(text, blocks)]))
    assert read.open == []
    said = text.strip()
    found = [tag for tag, words in read.texts if words == said]
    assert found[:-1] == (["title", "h1", "p", "h2", "p", "li", "caption", "th"] if said else [])
    assert set(found[-1:]) <= {"td", "th"}  # of numbers the first column heads its row


def test_nothing_is_loaded_from_elsewhere(page):
    read = Reader(page)
    assert not read.named("link")
    assert not read.named("iframe")
    references = [
        value
        for _, attributes in read.elements
        for name, value in attributes.items()
        if name in {"src", "href", "srcset", "data", "action", "poster"}
    ]
    assert len(references) == 1
    assert references[0].startswith("data:image/png;base64,")
    assert "url(" not in page
    assert "@import" not in page
    assert "http://" not in page
    assert "https://" not in page


def test_a_picture_is_its_file_and_says_what_it_shows(page):
    (image,) = Reader(page).named("img")
    assert base64.b64decode(image["src"].partition(",")[2]) == PNG
    assert image["alt"] == f"shows {NASTY}"
    assert image["style"] == "--width: 1px"


def test_sections_without_blocks_are_left_out(page):
    assert ("h2", "empty") not in Reader(page).texts


def test_the_page_fits_a_phone_and_both_lights(page):
    (viewport,) = [m for m in Reader(page).named("meta") if m.get("name") == "viewport"]
    assert "width=device-width" in viewport["content"]
    assert "color-scheme: light dark" in page


def test_tables_of_many_columns_are_printed_small():
    for columns, attributes in ((8, {}), (9, {"class": "wide"})):
        grid = Grid(["a"] * columns, [["b"] * columns])
        (table,) = Reader(render_page("", "", [Section("", [grid])])).named("table")
        assert table == attributes


def test_sentences_begin_on_one_line_and_numbers_end_on_one():
    sentence = "The gyroscope with mean wheel speed is better here."
    grid = Grid(("run", "error", "note"), [("a", "0.01", "-"), ("b", "0.02", sentence)])
    read = Reader(render_page("", "", [Section("", [grid])]))
    words = {"class": "words"}
    assert read.named("td") == [{}, words, {}, words]
    assert [cell.get("class") for cell in read.named("th")][:3] == [None, None, "words"]


def test_the_same_content_gives_the_same_bytes(tmp_path, picture):
    sections = [Section("one", (picture,))]
    files = [write_page(tmp_path / name, "a", "b", sections) for name in ("1.html", "2.html")]
    assert files[0].read_bytes() == files[1].read_bytes()


def test_a_name_that_is_no_unicode_does_not_stop_the_page(tmp_path):
    """A folder name of undecodable bytes reaches Python as lone surrogates."""
    file = write_page(tmp_path / "a.html", "run\udcff", "", [])
    assert "run?" in file.read_text(encoding="utf-8")
