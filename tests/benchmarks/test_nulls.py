"""The page of null worlds says what its rows say, and is the one that is kept."""

import nulls
import pyarrow as pa
import pyarrow.parquet as parquet

ROW = {
    "error": None, "run.processor_seconds": 2.0, "run.ended": 1.7e9, "run.memory": 2**30,
    "run.code": "0.3, abc", "false_name": False, "below_5_percent": 0.05,
}  # fmt: skip


def sweep(folder, rows):
    (folder / "records").mkdir(parents=True)
    parquet.write_table(pa.Table.from_pylist(rows), folder / "records" / "rows.parquet")
    (folder / "result.json").write_text('{"about": "Nulls", "digest": "d"}')
    return folder


def test_a_row_counts_false_names_and_errors(tmp_path):
    rows = [ROW, ROW, {**ROW, "false_name": True}, {**ROW, "error": "it fell over"}]
    row = nulls.row_of(sweep(tmp_path / "out", rows))
    assert (row["worlds"], row["failed"], row["false_names"]) == (3, 1, 1)
    assert row["all_seconds"] == 6.0
    assert row["code"] == ["0.3, abc"]
    text = nulls.page([row])
    assert "| Nulls | 3, failed 1 | 1 [6.1, 79.2 %] | - | 5.0 % |" in text


def test_a_whole_search_says_how_often_it_was_silent(tmp_path):
    rows = [
        {**ROW, "verdict": v, "named": n} for v, n in (("nothing missing", []), ("named", ["x"]))
    ]
    row = nulls.row_of(sweep(tmp_path / "out", rows))
    assert (row["silent"], row["false_names"]) == (1, 1)
