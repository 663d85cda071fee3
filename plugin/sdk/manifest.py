# SPDX-License-Identifier: GPL-2.0-or-later
"""manifest.py FOLDER VERSION SOURCE YADE_LIBDIR: writes FOLDER/manifest.json, by which the loader knows a whole and fitting library from another one."""
import json
import os
import subprocess
import sys
import zlib

import facts


def commitOf(source):
	"""Revision of the source tree; None outside of git or without it."""
	try:
		return subprocess.run(['git', '-C', source, 'describe', '--always', '--dirty'], capture_output=True, text=True).stdout.strip() or None
	except OSError:
		return None


def main(folder, version, source, yadeLibDir):
	elf, yade = facts.elfModule(), facts.read(yadeLibDir)
	files = {}
	for where, _, names in os.walk(folder):
		for name in names:
			if name.endswith('.so'):
				with open(os.path.join(where, name), 'rb') as file:
					data = file.read()
				files[os.path.relpath(os.path.join(where, name), folder)] = {'size': len(data), 'crc32': zlib.crc32(data)}
	content = {
	        'version': version,
	        'commit': commitOf(source),
	        'python': yade['PYTHON'],
	        'yade': yade['VERSION'],
	        'yadePackage': yade['PACKAGE'],
	        'yadeLibDir': yadeLibDir,
	        'yadeBuildIds': {name: elf.buildId(os.path.join(yadeLibDir, name)) for name in facts.LIBRARIES},
	        'files': files
	}
	with open(os.path.join(folder, 'manifest.json'), 'w') as file:
		json.dump(content, file, indent=1)


if __name__ == '__main__':
	main(*sys.argv[1:])
