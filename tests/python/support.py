# SPDX-License-Identifier: GPL-2.0-or-later
"""What several Python tests share: the data files."""
import csv
from pathlib import Path

DATA = Path(__file__).resolve().parent.parent / 'data'


def table(name):
	"""Rows of a data file as dicts of strings; lines that start with # are its head."""
	with open(DATA / name, newline='') as f:
		return list(csv.DictReader(line for line in f if not line.startswith('#')))
