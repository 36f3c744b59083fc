"""Folders of results that are written and read in short."""

from identification.storage.folders import whole_folder
from identification.storage.made import list_content


def content(folder):
    """The texts of the files of a folder, by name, but for hidden ones."""
    files = [p for p in folder.iterdir() if p.is_file() and p.name[0] != "."]
    return {p.name: p.read_text(errors="replace") for p in files}


def made(out, **texts):
    """Writes results, a file for each text."""
    with whole_folder(out) as draft:
        for name, text in texts.items():
            (draft / name).write_text(text)


def list_foreign(folder):
    """The files of a folder that were not made there, or were changed since."""
    return list_content(folder).foreign if folder.is_dir() else []
