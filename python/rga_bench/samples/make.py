"""The files of a sample, and the archives that are shipped."""

import io
import json
from datetime import datetime, timedelta
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

from rga.files import write_whole
from rga_bench.samples.catalogue import SAMPLES, SampleDesign, answer
from rga_bench.samples.logger_file import (
    DATE,
    DATE_FORMAT,
    ENCODING,
    SPARE,
    TIME,
    TIME_FORMAT,
    logger_file,
)
from rga_bench.swinging import ModalCase

#: of the steel that all are built of, S355 [Pa]
YIELD_STRENGTH = 3.55e8
#: the oldest moment that an archive can state: archives of the same files are the same
NO_DATE = (1980, 1, 1, 0, 0, 0)

MAPPING = f"""\
# How to read logger.csv: what its lines, columns and cells mean.
files = ["logger.csv"]
encoding = "{ENCODING}"
delimiter = ";"
decimal = ","
header_line = {{header_line}}
units_line = {{units_line}}
missing = ["-9999", "Overrange"]

[time]
columns = ["{DATE}", "{TIME}"]
format = "{DATE_FORMAT} {TIME_FORMAT}"

[unused]
{SPARE} = "spare input, nothing is connected"
"""

README = """\
{title}

{what}

  model.json    the structure as it was designed
  logger.csv    some days of readings, as the logger wrote them
  import.toml   how to read logger.csv
  answer.txt    what is wrong with the structure: read it last

Something about the structure is not as the model has it. To find out what:

  rga check model.json logger.csv
  rga draw model.json -o model.html
  rga diagnose model.json logger.csv -o findings

The report is findings/report.html. The structure and its readings are made up.
"""

README_MODES = """\
{title}

{what}

  model.json    the structure as it was designed, with its masses
  modes.csv     natural frequencies and mode shapes, window by window, without names
  answer.txt    what is wrong with the structure: read it last

Something about the structure is not as the model has it. To find out what:

  rga check model.json
  rga modes model.json modes.csv
  rga diagnose model.json --modal modes.csv -o findings

The report is findings/report.html. The structure and its modes are made up.
"""


def sample_files(design: SampleDesign) -> dict[str, bytes]:
    """The files of a sample by name."""
    case = design.draw(design.seed)
    about = {"client": design.client, "structure": design.title}
    model = {"rga_model": 1, "name": design.title, "about": about} | {
        key: value for key, value in case.model.items() if key not in ("rga_model", "name")
    }
    model["materials"] = {
        name: {**material, "yield_strength": YIELD_STRENGTH}
        for name, material in case.model["materials"].items()
    }
    model_file = (json.dumps(model, indent=1) + "\n").encode()
    told = answer(case, design.start).encode()
    if isinstance(case, ModalCase):
        return {
            "README.txt": README_MODES.format(title=design.title, what=design.what).encode(),
            "answer.txt": told,
            "model.json": model_file,
            "modes.csv": dated(case.modal, design.start).encode(),
        }
    log = logger_file(case, design.site, design.station, design.start, design.seed)
    mapping = MAPPING.format(header_line=log.header_line, units_line=log.header_line + 1)
    return {
        "README.txt": README.format(title=design.title, what=design.what).encode(),
        "answer.txt": told,
        "import.toml": mapping.encode(),
        "logger.csv": log.content,
        "model.json": model_file,
    }


def dated(table: str, start: datetime) -> str:
    """A table whose first column is time [s], with dates in its place.

    >>> dated("time,f\\n3600,1.5\\n", datetime(2024, 1, 22))
    'time,f\\n2024-01-22T01:00:00,1.5\\n'
    """
    head, *rows = table.splitlines()
    lines = [head]
    for row in rows:
        time, rest = row.split(",", 1)
        lines.append(f"{(start + timedelta(seconds=float(time))).isoformat()},{rest}")
    return "\n".join(lines) + "\n"


def archive(files: dict[str, bytes]) -> bytes:
    """Files as a zip archive."""
    written = io.BytesIO()
    with ZipFile(written, "w", ZIP_DEFLATED, compresslevel=9) as target:
        for name, content in files.items():
            target.writestr(ZipInfo(name, NO_DATE), content, ZIP_DEFLATED, 9)
    return written.getvalue()


def make_samples(folder: Path) -> None:
    """Write all archives into a folder that exists."""
    write_whole(
        {folder / f"{name}.zip": archive(sample_files(one)) for name, one in SAMPLES.items()}
    )
