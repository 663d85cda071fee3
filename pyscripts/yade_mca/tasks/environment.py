# SPDX-License-Identifier: GPL-2.0-or-later
"""What a result depends on besides its input: version, commit, threads, instruction level, processor."""
import importlib
import os
import re
import subprocess
from functools import lru_cache
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[1]
SOURCE = PACKAGE.parents[1]  #: top of the source tree, when the package lies in one


@lru_cache(maxsize=None)
def _plugin(name):
	"""Attribute `name` of the package with the plugin loaded; None where it cannot be loaded."""
	try:
		return getattr(importlib.import_module('yade_mca'), name, None)
	except ImportError:
		return None


@lru_cache(maxsize=None)
def version():
	"""Version of the plugin, else of the source tree by its CMakeLists.txt; None outside one."""
	if _plugin('version'):
		return _plugin('version')
	cmake = SOURCE / 'CMakeLists.txt'
	found = re.search(r'project\([^)]*?VERSION\s+([\d.]+)', cmake.read_text()) if cmake.exists() else None
	return found.group(1) if found else None


@lru_cache(maxsize=None)
def commit():
	"""Git commit of the source tree, with '+' when files under version control were changed; outside one that of the build, or None."""
	if not (SOURCE / '.git').exists():
		return _plugin('commit')
	git = lambda *args: subprocess.run(['git', '-C', str(SOURCE), *args], capture_output=True, text=True, timeout=20)
	try:
		head = git('rev-parse', 'HEAD')
		if head.returncode:
			return None
		return head.stdout.strip() + ('+' if git('diff', '--quiet', 'HEAD').returncode else '')
	except (OSError, subprocess.TimeoutExpired):
		return None


def cores():
	"""Processors this process may use."""
	return len(os.sched_getaffinity(0))


def threads():
	"""Threads that OpenMP uses: OMP_NUM_THREADS, else all processors."""
	first = os.environ.get('OMP_NUM_THREADS', '').split(',')[0].strip()
	return int(first) if first.isdigit() and int(first) > 0 else cores()


def isa():
	"""Instruction level of the solver library in use; None when the plugin cannot be loaded."""
	info = _plugin('McaInfo')
	return info().isa if info else None


@lru_cache(maxsize=None)
def processor():
	"""Name of the processor; None when the system does not tell."""
	try:
		found = re.search(r'^model name\s*:\s*(.+)$', Path('/proc/cpuinfo').read_text(), re.M)
		return found.group(1).strip() if found else None
	except OSError:
		return None
