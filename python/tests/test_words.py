"""The documents are in plain English: the crude part of it."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = [page for page in [*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")] if page.exists()]
# This page records the history of the code.
SPARED = {"CHANGELOG.md"}

SOURCES = sorted(ROOT.glob("crates/*/src/**/*.rs"))
# A comment of these kinds has no subject, or does not stand alone.
NOT_ALONE = re.compile(r"^\s*//[/!]? (?:What|That|Of|Those|Which|The same with|As (?:of|that|those|\[)) ", re.MULTILINE)

NOT_ENGLISH = {
    r"(?:^|[.:!?] )(?:Of|Those of|The same with|That of|That is) ": "begins without its subject",
    r"\bone's own\b": "say custom, user-defined or your own",
    r"\bwhat faces\b|\bfaces all\b": "say overlap",
    r"\b(?:foretells?|foretold)\b": "say predict or estimate",
    r"\bthat others used\b|\bfor which there was no machine\b": "belongs to benches/NOTES.md",
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


@pytest.mark.parametrize("crate", sorted({source.relative_to(ROOT).parts[1] for source in SOURCES}))
def test_a_comment_stands_alone(crate):
    # Pages and figures of the command are still to be rewritten.
    later = [ROOT / "crates/asperity-report/src" / part for part in ("page", "figures", "draw")]
    found = [
        f"{source.relative_to(ROOT)}: {match.group().strip()} …"
        for source in SOURCES
        if source.relative_to(ROOT).parts[1] == crate and not any(part in source.parents for part in later)
        for match in NOT_ALONE.finditer(source.read_text(encoding="utf-8"))
    ]
    assert not found, "\n".join(found)


def test_a_comment_that_does_not_stand_alone_is_found():
    assert NOT_ALONE.search("    /// What a cell bears.") and NOT_ALONE.search("//! Of the cells one.")
    assert not NOT_ALONE.search("/// Offset of the cells.\n// A cell of that kind")


def test_a_crude_mistake_is_found():
    wrong = "# A title\n\nOf the cases only one.\n\n```text\nOf code, nothing.\n```\n\n| Of tables | neither |\n"
    assert [paragraph for paragraph in prose(wrong) if re.match("Of ", paragraph)] == ["Of the cases only one."]
