"""Writes Messung_Sand.xlsx: the runs of ../hidden-effect as a German rig engineer keeps them.

    python make_messung.py        # needs openpyxl; the committed file was made with 3.1
"""

import csv
import math
import pathlib

import openpyxl

HERE = pathlib.Path(__file__).resolve().parent
RADIUS_M = 0.125
TITLES = ["Versuch", "Radlast [kN]", "Schlupf [%]", "Drehzahl [U/min]", "Zugkraft [N]", "Drehmoment [Ncm]", "Einsinkung [mm]", "Verwendung", "Bediener", "Bemerkung"]


def runs():
    lines = (HERE.parent / "hidden-effect/runs.csv").read_text().splitlines()
    return csv.DictReader(line for line in lines if not line.startswith("#"))


def comma(value):
    """A number as it is typed where the cell is a text."""
    return f"{value:.10g}".replace(".", ",")


def row(number, run):
    slip = float(run["slip"])
    rim_m_s = float(run["sled_speed_m_s"]) / (1 - slip)
    cells = [
        f"V{number:02d}",
        float(run["wheel_load_n"]) / 1000,
        round(slip * 100, 9),
        round(rim_m_s / RADIUS_M * 60 / (2 * math.pi), 8),
        float(run["drawbar_pull_n"]),
        round(float(run["torque_n_m"]) * 100, 6),
        round(float(run["sinkage_m"]) * 1000, 7),
        run["use"],
        "K. Weber" if number % 3 else "A. Yıldız",
        "Sand neu aufbereitet" if number % 10 == 1 else None,
    ]
    # Every fourth row was pasted from a logger: its numbers are texts.
    return [comma(cell) if isinstance(cell, float) and number % 4 == 0 else cell for cell in cells]


book = openpyxl.Workbook()
sheet = book.active
sheet.title = "Messung"
sheet.append(["Einzelradprüfstand, trockener Sand"])
sheet.append(["Rad: glatt, R = 125 mm, B = 112 mm"])
sheet.append([])
sheet.append(TITLES)
for number, run in enumerate(runs(), start=1):
    sheet.append(row(number, run))
sheet.merge_cells("A1:J1")
notes = book.create_sheet("Prüfstand")
notes.append(["Kraftmessdose", "HBM U9C, kalibriert"])
book.save(HERE / "Messung_Sand.xlsx")
