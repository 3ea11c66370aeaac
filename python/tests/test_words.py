"""The documents are in plain English: the crude part of it."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = [page for page in [*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")] if page.exists()]
# These record the history of the code, or are written for its developers.
SPARED = {"CHANGELOG.md", "ARCHITECTURE.md", "STYLE.md", "docs/notes.md", "docs/theory.md"}

NOT_ENGLISH = {
    r"(?:^|[.:!?] )(?:Of|Those of|The same with|That of|That is) ": "begins without its subject",
    r"\bone's own\b": "say custom, user-defined or your own",
    r"\bwhat faces\b|\bfaces all\b": "say overlap",
    r"\b(?:foretells?|foretold)\b": "say predict or estimate",
    r"\bthat others used\b|\bfor which there was no machine\b": "belongs to docs/notes.md",
    r"\bfrom there on\b": "say from here on",
    r"\bwhat has flowed\b|\bbodies (?:that|which) flow\b": "say plastic state, elasto-plastic bodies",
    r"\bat rest\b": "say static",
}


def prose(page):
    """The sentences of a page outside of code, generated tables and headings, each in one line."""
    text = re.sub(r"^---\n.*?^---\n", "", page, flags=re.S | re.M)
    text = re.sub(r"^ *(```|:::).*?^ *\1", "", text, flags=re.S | re.M)
    text = re.sub(r"^(#.*|\|.*|<!--.*)$", "", text, flags=re.M)
    paragraphs = re.split(r"\n\s*\n|\n(?=\s*[-0-9]+\.? )", text)
    return [re.sub(r"^[-0-9.]+ ", "", " ".join(each.split())) for each in paragraphs if each.strip()]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_a_page_is_in_plain_english(page):
    if page.relative_to(ROOT).as_posix() in SPARED:
        pytest.skip("not written for users")
    found = [
        f"{message}: {paragraph[max(match.start() - 30, 0) : match.end() + 40]}"
        for paragraph in prose(page.read_text(encoding="utf-8"))
        for pattern, message in NOT_ENGLISH.items()
        for match in re.finditer(pattern, paragraph)
    ]
    assert not found, "\n".join(found)


def test_a_crude_mistake_is_found():
    wrong = "# A title\n\nOf the cases only one.\n\n```text\nOf code, nothing.\n```\n\n| Of tables | neither |\n"
    assert [paragraph for paragraph in prose(wrong) if re.match("Of ", paragraph)] == ["Of the cases only one."]
