"""Writes tests/files: the same six runs as spreadsheets and as MATLAB files.

    python make_files.py        # needs numpy, scipy, h5py, openpyxl, odfpy and xlwt

Versions that the committed files were made with: numpy 2.4, scipy 1.17, h5py 3.16, openpyxl 3.1, odfpy 1.4, xlwt 1.3.
"""

import pathlib

import h5py
import numpy
import openpyxl
import scipy.io
import xlwt
from odf.opendocument import OpenDocumentSpreadsheet
from odf.table import Table, TableCell, TableRow
from odf.text import P

FILES = pathlib.Path(__file__).resolve().parent / "files"
TITLES = ["run", "slip [%]", "load [kN]", "speed [mm/s]", "pull [N]", "torque [N cm]", "sinkage [mm]", "operator"]
ROWS = [
    ["a1", 10, 0.1, 8, 12.5, 310, 5.25, "Ada"],
    ["a2", 20, 0.1, 8, 25, 420, 6.5, "Ada"],
    ["a3", 40, 0.1, 8, 35.75, 590, 8, "Grace"],
    ["a4", -20, 0.1, 8, -20.5, 15, 4, "Grace"],
    ["a5", 0, 0.15, 8, 1.5, 205, 6, None],
    ["a6", 30, 0.15, 8, None, 680, 9.125, None],
]
NAMES = ["run", "slip", "load_kN", "speed_mm_s", "pull", "torque", "sinkage", "operator"]


def columns():
    return {name: [row[k] for row in ROWS] for k, name in enumerate(NAMES)}


def sheet_rows():
    return [["Rig 3, dry sand"], [], TITLES, *ROWS]


def xlsx():
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.title = "Runs"
    for row in sheet_rows():
        sheet.append(row)
    sheet.merge_cells("A1:H1")
    book.save(FILES / "runs.xlsx")

    # Two sheets; texts with decimal commas; the load once for three rows; a formula that nobody has computed.
    book.create_sheet("Notes").append(["nothing here"])
    sheet["E4"] = "12,5"
    sheet["C4"] = 0.1
    sheet["C5"] = sheet["C6"] = None
    sheet.merge_cells("C4:C6")
    sheet["G9"] = "=9+0.125"
    book.save(FILES / "awkward.xlsx")


def ods():
    document = OpenDocumentSpreadsheet()
    table = Table(name="Runs")
    for row in sheet_rows():
        line = TableRow()
        for value in row:
            if value is None:
                line.addElement(TableCell())
            elif isinstance(value, str):
                cell = TableCell(valuetype="string")
                cell.addElement(P(text=value))
                line.addElement(cell)
            else:
                cell = TableCell(valuetype="float", value=str(value))
                cell.addElement(P(text=str(value).replace(".", ",")))
                line.addElement(cell)
        table.addElement(line)
    document.spreadsheet.addElement(table)
    document.save(FILES / "runs.ods")


def xls():
    book = xlwt.Workbook()
    sheet = book.add_sheet("Runs")
    for r, row in enumerate(sheet_rows()):
        for c, value in enumerate(row):
            if value is not None:
                sheet.write(r, c, value)
    book.save(str(FILES / "runs.xls"))


def vectors():
    """Column vectors, and cell arrays of texts."""
    found = {}
    for name, values in columns().items():
        if name in ("run", "operator"):
            found[name] = numpy.array([value or "" for value in values], dtype=object).reshape(-1, 1)
        else:
            found[name] = numpy.array([numpy.nan if value is None else value for value in values], dtype=float).reshape(-1, 1)
    return found


def mat5():
    scipy.io.savemat(FILES / "vectors-v7.mat", vectors() | {"rig": "Rig 3", "cube": numpy.zeros((2, 2, 2))}, do_compression=True)
    scipy.io.savemat(FILES / "struct-v6.mat", {"data": vectors()}, do_compression=False)
    elements = numpy.empty((1, len(ROWS)), dtype=[(name, object) for name in NAMES])
    for k, row in enumerate(ROWS):
        for name, value in zip(NAMES, row):
            elements[0, k][name] = numpy.zeros((0, 0)) if value is None else value
    scipy.io.savemat(FILES / "elements-v7.mat", {"runs": elements}, do_compression=True)


def mat73():
    """As MATLAB 7.3 writes it: a header of 512 bytes, sizes in reverse, chunks with deflate, texts as references."""
    path = FILES / "vectors-v73.mat"
    with h5py.File(path, "w", userblock_size=512) as file:
        parts = file.create_group("#refs#")
        group = file.create_group("data")
        group.attrs["MATLAB_class"] = numpy.bytes_("struct")
        for name, values in vectors().items():
            if values.dtype == object:
                references = []
                for text in values[:, 0]:
                    codes = numpy.array([[ord(c)] for c in text], dtype=numpy.uint16) if text else numpy.array([0, 0], dtype=numpy.uint64)
                    part = parts.create_dataset(f"part{len(parts)}", data=codes)
                    part.attrs["MATLAB_class"] = numpy.bytes_("char")
                    if not text:
                        part.attrs["MATLAB_empty"] = numpy.uint8(1)
                    references.append(part.ref)
                own = group.create_dataset(name, data=numpy.array([references], dtype=h5py.ref_dtype), dtype=h5py.ref_dtype)
                own.attrs["MATLAB_class"] = numpy.bytes_("cell")
            else:
                own = group.create_dataset(name, data=values.T, chunks=(1, 4), compression="gzip")
                own.attrs["MATLAB_class"] = numpy.bytes_("double")
    content = bytearray(path.read_bytes())
    content[:128] = b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(116) + bytes(8) + b"\x00\x02IM"
    path.write_bytes(content)


FILES.mkdir(exist_ok=True)
for make in (xlsx, ods, xls, mat5, mat73):
    make()
