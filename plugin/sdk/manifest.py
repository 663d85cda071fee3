# SPDX-License-Identifier: GPL-2.0-or-later
"""manifest.py FOLDER VERSION SOURCE YADE_LIBDIR: writes FOLDER/manifest.json, by which the loader knows a whole and fitting library from another one."""
import importlib.util
import json
import os
import subprocess
import sys
import zlib


def main(folder, version, source, yadeLibDir):
	spec = importlib.util.spec_from_file_location('elf', os.path.join(source, 'pyscripts', 'yade_mca', '_elf.py'))
	elf = importlib.util.module_from_spec(spec)
	spec.loader.exec_module(elf)
	files = {}
	for where, _, names in os.walk(folder):
		for name in names:
			if name.endswith('.so'):
				with open(os.path.join(where, name), 'rb') as file:
					data = file.read()
				files[os.path.relpath(os.path.join(where, name), folder)] = {'size': len(data), 'crc32': zlib.crc32(data)}
	commit = subprocess.run(['git', '-C', source, 'describe', '--always', '--dirty'], capture_output=True, text=True).stdout.strip()
	content = {
	        'version': version,
	        'commit': commit or None,
	        'python': '3.11',
	        'yade': '2023.02a',
	        'yadeLibDir': yadeLibDir,
	        'yadeBuildIds': {name: elf.buildId(os.path.join(yadeLibDir, name)) for name in ('libyade.so', 'libpkg_common.so', 'libpkg_dem.so')},
	        'files': files
	}
	with open(os.path.join(folder, 'manifest.json'), 'w') as file:
		json.dump(content, file, indent=1)


if __name__ == '__main__':
	main(*sys.argv[1:])
