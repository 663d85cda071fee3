# SPDX-License-Identifier: GPL-2.0-or-later
"""facts.py YADE_LIBDIR: what the installed YADE is and was built with, as lines of CMake on standard output. Loads nothing of YADE's.

MCA_YADE_VERSION 2025.2.0, MCA_YADE_NUMBER 20250200 (for #if), MCA_YADE_PYTHON 3.13, MCA_YADE_BOOST 1.83.0, MCA_YADE_PACKAGE (version of the package libyade, empty
without dpkg), MCA_YADE_STANDING: supported, tried (works, not promised) or unknown.
"""
import importlib.util
import os
import re
import subprocess
import sys

SUPPORTED = {'2023.02a': 'Debian 12', '2025.2.0': 'Debian 13'}  #: all tests pass there
TRIED = {'2026.1.0': 'Debian testing'}  #: builds, and the guard passes
LIBRARIES = ('libyade.so', 'libpkg_common.so', 'libpkg_dem.so')


def elfModule():
	"""The loader's reader of libraries; the package itself cannot be imported here, for it would load YADE."""
	path = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'pyscripts', 'yade_mca', '_elf.py')
	spec = importlib.util.spec_from_file_location('elf', path)
	elf = importlib.util.module_from_spec(spec)
	spec.loader.exec_module(elf)
	return elf


def number(version):
	"""20230200 for 2023.02a, 20250201 for 2025.2.1: years, months and corrections in order. Raises ValueError for anything else."""
	found = re.fullmatch(r'(20\d\d)\.(\d\d?)(?:([a-z])|\.(\d\d?))?', version)
	if not found: raise ValueError("the version of YADE is '%s', not of the form 2023.02a or 2025.2.0" % version)
	year, month, letter, patch = found.groups()
	return int(year) * 10000 + int(month) * 100 + (ord(letter) - ord('a') if letter else int(patch or 0))


def packageVersion(name):
	try:
		return subprocess.run(['dpkg-query', '-W', '-f', '${Version}', name], capture_output=True, text=True).stdout.strip()
	except OSError:
		return ''


def read(libDir):
	"""The facts as a dict of strings. Raises ValueError or OSError when this is no YADE."""
	with open(os.path.join(libDir, 'py', 'yade', 'config.py'), encoding='utf-8') as file:
		found = re.search(r"^version *= *'(.*?)'", file.read(), re.M)
	if not found: raise ValueError('%s/py/yade/config.py names no version' % libDir)
	version = found[1]
	needed = ' '.join(elfModule().needed(os.path.join(libDir, 'libpkg_common.so')))
	boost = re.search(r'libboost_python(\d)(\d+)\.so\.([\d.]+)', needed)
	if not boost: raise ValueError('%s/libpkg_common.so needs no libboost_pythonXY.so: %s' % (libDir, needed))
	standing = 'supported' if version in SUPPORTED else 'tried' if version in TRIED else 'unknown'
	return dict(VERSION=version, NUMBER=str(number(version)), PYTHON='%s.%s' % (boost[1], boost[2]), BOOST=boost[3], PACKAGE=packageVersion('libyade'), STANDING=standing)


if __name__ == '__main__':
	try:
		for key, value in read(sys.argv[1]).items():
			print('set(MCA_YADE_%s "%s" CACHE INTERNAL "")' % (key, value))
	except (OSError, ValueError) as e:
		sys.exit('facts.py: %s' % e)
