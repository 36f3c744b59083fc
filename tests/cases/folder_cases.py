"""Folders of results that are written and read in short."""

from identification.folders import whole_folder


def content(folder):
    """The texts of the files of a folder, by name, but for hidden ones."""
    files = [p for p in folder.iterdir() if p.is_file() and p.name[0] != "."]
    return {p.name: p.read_text(errors="replace") for p in files}


def made(out, **texts):
    """Writes results, a file for each text."""
    with whole_folder(out) as draft:
        for name, text in texts.items():
            (draft / name).write_text(text)
