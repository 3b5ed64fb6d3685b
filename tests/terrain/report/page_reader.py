"""What a page holds, read by its tags; and settings under which small runs have errors."""

from html.parser import HTMLParser

from odometry.evaluation.relative import EvaluationConfig
from terrain.config import Config

SHORT = Config(evaluation=EvaluationConfig(horizon_m=1.0, stride_m=0.25))


class Reader(HTMLParser):
    """Texts, tables as rows of cells, and images of a page."""

    def __init__(self, file):
        super().__init__()
        self.tags, self.texts, self.tables, self.images = [], [], [], []
        self.feed(file.read_text(encoding="utf-8"))
        self.close()

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        if tag == "table":
            self.tables.append([])
        elif tag == "tr":
            self.tables[-1].append([])
        elif tag in {"td", "th"}:
            self.tables[-1][-1].append("")
        elif tag == "img":
            self.images.append(dict(attrs))

    def handle_data(self, data):
        self.texts.append(data)
        if self.tags and self.tags[-1] in {"td", "th"}:
            self.tables[-1][-1][-1] += data.rstrip("\n")

    @property
    def text(self):
        return " ".join(self.texts)

    def table(self, column):
        """Header and rows of the table that has such a column."""
        (found,) = [table for table in self.tables if column in table[0]]
        return found[0], found[1:]
