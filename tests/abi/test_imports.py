# SPDX-License-Identifier: GPL-2.0-or-later
"""Python files of the package and of the tests import nothing that they do not use."""
import ast
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def unused(text):
	"""Names that `text` imports and never mentions, with their lines. Words in strings count as mentioned where they name what is exported or are run as a script."""
	tree = ast.parse(text)
	lines = text.splitlines()
	imported = {}
	for node in ast.walk(tree):
		if isinstance(node, (ast.Import, ast.ImportFrom)) and 'noqa: F401' not in lines[node.lineno - 1]:
			for a in node.names: imported[(a.asname or a.name).split('.')[0]] = node.lineno
	used = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
	for node in ast.walk(tree):
		if isinstance(node, ast.Assign) and any(isinstance(t, ast.Name) and t.id == '__all__' for t in node.targets): used |= set(re.findall(r'\w+', ast.unparse(node.value)))
	return ['%d: %s' % (line, name) for name, line in sorted(imported.items()) if name not in used and name != '*']


def test_noImportIsUnused():
	files = [p for d in ('pyscripts', 'tests', 'plugin') for p in (ROOT / d).rglob('*.py') if p.name != '__init__.py' and '__pycache__' not in p.parts]
	found = ['%s:%s' % (p.relative_to(ROOT), name) for p in files for name in unused(p.read_text())]
	assert len(files) > 100 and not found, '\n'.join(found)


def test_theTestSeesUnusedImports():
	assert unused('import os, sys\nfrom a import b as c, d\nprint(sys.path, d)\n') == ['2: c', '1: os']
	assert unused("from a import b\n__all__ = ['b']\n") == unused('import yade_mca  # noqa: F401  loads the classes\n') == unused('from a import *\n') == []
	assert unused('def f():\n\tfrom a import b\n\treturn 1\n') == ['2: b']
