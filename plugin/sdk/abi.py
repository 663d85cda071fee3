# SPDX-License-Identifier: GPL-2.0-or-later
"""`pyscripts/run abi [--yade FOLDER] [--json FILE]`: what an installed YADE, of any version, has other than plugin/sdk/include declares; nothing of it is loaded.

Compared are the sizes of objects (what the library allocates for one), the virtual tables, and the functions that the built extension needs. The declared side comes from the
compiler, the other from the library's file. Offsets of members cannot be seen so: the guard compares them at import. Status: 0 nothing differs, 1 something does, 2 it cannot be measured.
"""
import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

import facts

HERE = os.path.dirname(os.path.abspath(__file__))
DEFAULT = '/usr/lib/x86_64-linux-gnu/yade-double'
#: as in plugin/cmake/YadeExtension.cmake
DEFINITIONS = ('EIGEN_DONT_ALIGN', 'EIGEN_DONT_VECTORIZE', 'EIGEN_DONT_PARALLELIZE', 'EIGEN_DISABLE_UNALIGNED_ARRAY_ASSERT', 'BOOST_BIND_GLOBAL_PLACEHOLDERS',
               'BOOST_ALLOW_DEPRECATED_HEADERS', 'MCA_SDK_NO_LAYOUT_ASSERT')
PARTIAL = ('Cell', 'InteractionLoop')  #: declared only as far as they are used: never made, derived from or copied
LAYOUT = ('OPENMP', 'MPI', 'QT5', 'FEMLIKE', 'LS_DEM'), ('MASK_ARBITRARY', 'SPH', 'LIQMIGRATION', 'DEFORM', 'PROFILING')  #: features that must be on, and off


def output(*command, **options):
	return subprocess.run([str(c) for c in command], stdout=subprocess.PIPE, check=True, text=True, **options).stdout


def declared(number):
	"""({class: size}, {class: [function of each slot]}) of the declarations, for the version with this number."""
	include = os.path.join(HERE, 'include')
	headers = sorted(os.path.relpath(os.path.join(where, name), include) for part in ('core', 'lib', 'pkg') for where, _, names in os.walk(os.path.join(include, part)) for name in names)
	python = output('/usr/bin/python3', '-c', "import sysconfig; print(sysconfig.get_path('include'))").strip()
	with tempfile.TemporaryDirectory() as folder:
		source, dump = os.path.join(folder, 'all.cpp'), os.path.join(folder, 'classes')
		with open(source, 'w') as file:
			file.write(''.join('#include <%s>\n' % h for h in headers if h.endswith('.hpp')))
		flags = ['-I' + include, '-I' + os.path.join(HERE, 'helpers'), '-isystem', '/usr/include/eigen3', '-isystem', python, *('-D' + d for d in DEFINITIONS), '-DMCA_YADE_NUMBER=%d' % number]
		output('g++', '-std=c++17', '-fopenmp', '-fsyntax-only', '-w', '-fdump-lang-class=' + dump, *flags, source)
		with open(dump) as file:
			text = file.read()
	sizes = {name: int(size) for name, size in re.findall(r'^Class yade::(\w+)\n   size=(\d+)', text, re.M)}
	tables = {}
	for name, body in re.findall(r'^Vtable for yade::(\w+)\n.*\n((?:\d+ .*\n)+)', text, re.M):
		entries = [line.split('(int (*)(...))')[-1] for line in body.splitlines()][2:]
		end = next((n for n, e in enumerate(entries) if re.fullmatch(r'-\d+', e)), len(entries))  # the table of a second base follows
		tables[name] = [plain(e) for e in entries[:end]]
	for cls in PARTIAL:
		sizes.pop(cls), tables.pop(cls)
	return sizes, tables


def plain(name):
	"""Class and function without namespace, arguments of templates and of the function."""
	name = re.sub(r'\[abi:\w+\]', '', name)
	while re.search(r'<[^<>]*>', name):
		name = re.sub(r'<[^<>]*>', '', name)
	return re.sub(r'\(.*', '', name).split(' ')[-1].removeprefix('yade::')


def readable(names):
	"""plain() of mangled names, in one call for all."""
	return [plain(line) for line in output('c++filt', input='\n'.join(names) + '\n').splitlines()]


def sameFunction(a, b):
	"""The class may be another one: who overrides a function does not move its slot."""
	return a.split('::')[-1].lstrip('~') == b.split('::')[-1].lstrip('~') or '~' in a and '~' in b


class Library:
	"""Symbols and relocations of one shared library."""

	def __init__(self, path):
		self.path = path
		self.symbols, self.at = {}, {}  # name -> (address, size); address -> name
		for line in output('readelf', '--dyn-syms', '-W', path).splitlines():
			p = line.split()
			if len(p) < 8 or not p[0].endswith(':') or p[6] == 'UND' or not re.fullmatch('[0-9a-f]{16}', p[1]): continue
			name = p[7].split('@')[0]
			self.symbols[name] = (int(p[1], 16), int(p[2], 0))
			self.at.setdefault(int(p[1], 16), name)
		self._relocations = None

	def relocations(self):
		"""Address -> name of the function it will hold ('' when that has no name)."""
		if self._relocations is None:
			self._relocations = {}
			for line in output('readelf', '-rW', self.path).splitlines():
				found = re.match(r'([0-9a-f]{16})\s+[0-9a-f]+\s+R_X86_64_(64|RELATIVE)\s+(\S+)\s*(\S*)', line)
				if not found: continue
				self._relocations[int(found[1], 16)] = found[4].split('@')[0] if found[2] == '64' else self.at.get(int(found[3], 16), '')
		return self._relocations

	def table(self, cls):
		"""Mangled names in the virtual table of a class, or None when it has none here."""
		symbol = self.symbols.get('_ZTVN4yade%d%sE' % (len(cls), cls))
		if symbol is None: return None
		slots = [self.relocations().get(symbol[0] + at) for at in range(16, symbol[1], 8)]
		return slots[:slots.index(None)] if None in slots else slots  # the table of a second base begins with a number

	def size(self, cls):
		"""Bytes the library allocates for an object of a class; None when it makes none here or the code is not understood."""
		name = 'CreatePureCustom' + cls
		start = self.symbols.get('_ZN4yade%d%sEv' % (len(name), name))
		if start is None: return None
		code = output('objdump', '-d', '--no-show-raw-insn', '--start-address=%d' % start[0], '--stop-address=%d' % (start[0] + 160), self.path)
		found = re.search(r'mov\s+\$0x([0-9a-f]+),%edi.*\n(?:.*\n){0,4}?.*call.*<(?:_Znwm|.*malloc)', code)
		return int(found[1], 16) if found else None


def missing(folder, libraries):
	"""(how many functions of YADE's the built extension asks for, those the libraries lack); None where there is no build."""
	build = os.environ.get('YADE_MCA_BUILD') or os.path.join(HERE, '..', '..', 'build')
	extension = os.path.join(os.environ.get('YADE_MCA_LIB') or os.path.join(build, 'yade_mca_lib'), '_yade_mca.so')
	if not os.path.exists(extension): return None
	wanted = {line.split()[-1].split('@')[0] for line in output('nm', '-D', '--undefined-only', extension).splitlines()}
	wanted = {name for name in wanted if 'N4yade' in name or 'NK4yade' in name}
	there = set().union(*(library.symbols for library in libraries))
	return len(wanted), sorted(wanted - there)


def compare(folder):
	"""Everything as a dict; `differences` is a list of lines."""
	known = facts.read(folder)
	sizes, tables = declared(int(known['NUMBER']))
	libraries = [Library(os.path.join(folder, name)) for name in facts.LIBRARIES]
	found, differ = dict(sizes={}, tables=0, slots=0, unnamed=0), []
	for cls, size in sorted(sizes.items()):
		there = next((s for s in (library.size(cls) for library in libraries) if s), None)
		if there is None: continue
		found['sizes'][cls] = there
		if there != size: differ.append('size of %s: %d bytes in the library, %d declared' % (cls, there, size))
	for cls, slots in sorted(tables.items()):
		mangled = next((t for t in (library.table(cls) for library in libraries) if t), None)
		if mangled is None: continue
		names = readable([m or '-' for m in mangled])
		found['tables'] += 1
		for n, name in enumerate(slots):
			there = names[n] if n < len(names) else 'nothing'
			if n < len(mangled) and mangled[n] == '': found['unnamed'] += 1
			elif not sameFunction(there, name):
				differ.append('virtual table of %s: slot %d holds %s, declared is %s' % (cls, n, there, name))
				break
			else: found['slots'] += 1
		else:
			if len(names) > len(slots): differ.append('virtual table of %s: %d slots in the library, %d declared; the next holds %s' % (cls, len(names), len(slots), names[len(slots)]))
	symbols = missing(folder, libraries)
	if symbols: differ += ['no function %s' % name for name in readable(symbols[1])] if symbols[1] else []
	with open(os.path.join(folder, 'py', 'yade', 'config.py'), encoding='utf-8') as file:
		features = re.search(r"^features *= *'(.*?)'", file.read(), re.M)
	features = features[1].split() if features else []
	differ += ['built without %s' % f for f in LAYOUT[0] if f not in features] + ['built with %s' % f for f in LAYOUT[1] if f in features]
	return dict(found, folder=folder, facts=known, features=features, symbols=symbols[0] if symbols else None, differences=differ)


def show(found):
	known = found['facts']
	print('YADE %s (package %s, %s) in %s: Python %s, Boost %s' % (known['VERSION'], known['PACKAGE'] or 'unknown', known['STANDING'], found['folder'], known['PYTHON'], known['BOOST']))
	print('compared: sizes of %d classes, %d virtual tables with %d slots, %s' % (len(found['sizes']), found['tables'], found['slots'],
		'no functions, for there is no build' if found['symbols'] is None else '%d functions' % found['symbols']))
	if found['unnamed']: print('%d slots hold functions without a name' % found['unnamed'])
	for line in found['differences']:
		print('  ' + line)
	if found['differences']:
		print('%d differences. A port needs a switch `#if MCA_YADE_NUMBER >= %s` in plugin/sdk/include for each, and its size in sdk/layout.hpp; plugin/sdk/README.md tells the way.' % (len(found['differences']), known['NUMBER']))
	elif known['STANDING'] == 'unknown':
		print('nothing differs. To be supported it needs its version in plugin/sdk/facts.py, a passing guard and all tests; plugin/sdk/README.md tells the way.')
	else: print('nothing differs')


def main():
	parser = argparse.ArgumentParser(prog='pyscripts/run abi', description='Sizes, virtual tables and functions of an installed YADE beside the declarations of plugin/sdk.')
	parser.add_argument('--yade', metavar='FOLDER', default=DEFAULT, help='folder of libyade.so (default: %(default)s); of another root, too')
	parser.add_argument('--json', metavar='FILE', help='write all that was found')
	options = parser.parse_args()
	for program in ('g++', 'readelf', 'objdump', 'nm', 'c++filt'):
		if not shutil.which(program):
			print('abi: %s is missing: apt-get install g++' % program, file=sys.stderr)
			return 2
	try:
		found = compare(options.yade)
		if options.json:
			with open(options.json, 'w') as file:
				json.dump(found, file, indent=1)
	except (OSError, ValueError) as e:
		print('abi: %s' % e, file=sys.stderr)
		return 2
	except subprocess.CalledProcessError as e:
		print('abi: %s failed; the messages above say why (pyscripts/setup installs what is needed)' % e.cmd[0], file=sys.stderr)
		return 2
	show(found)
	return 1 if found['differences'] else 0


if __name__ == '__main__':
	sys.exit(main())
