# SPDX-License-Identifier: GPL-2.0-or-later
"""What the compiler does not see: width of lines, length of functions."""
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SOURCES = sorted(p for folder in ('plugin', 'tests') for p in (ROOT / folder).rglob('*') if p.suffix in ('.cpp', '.hpp') and 'build' not in p.parts)
COLUMNS = 160  # of .clang-format; a tab counts eight
LINES = 60


def test_linesAreNotTooWide():
	wide = ['%s:%d has %d columns' % (p.relative_to(ROOT), n, len(line.expandtabs(8))) for p in SOURCES for n, line in enumerate(p.read_text().split('\n'), 1) if len(line.expandtabs(8)) > COLUMNS]
	assert not wide, '%d columns are allowed:\n%s' % (COLUMNS, '\n'.join(wide))


def bare(line):
	"""Without comments and the insides of strings."""
	return re.sub(r'//.*', '', re.sub(r'"(\\.|[^"])*"|\'(\\.|[^\'])\'', '""', line))


def longFunctions(text):
	"""(first line, lines, comment above) of the functions with more than LINES lines."""
	lines, opened, found = text.split('\n'), [], []
	for n, line in enumerate(lines):
		for c in bare(line):
			if c == '{': opened.append(n)
			elif c == '}' and opened:
				start = opened.pop()
				head = start - 1 if lines[start].strip() == '{' else start
				name = bare(lines[head])
				if n - start <= LINES or '(' not in name or re.match(r'\s*(inline )?(namespace|struct|class|enum|extern|union)\b', name): continue
				while head and lines[head - 1].startswith('template'):
					head -= 1
				above = head
				while above and lines[above - 1].strip().startswith('//'):
					above -= 1
				found.append((head + 1, n - start, '\n'.join(lines[above:head])))
	return found


def test_longFunctionsSayWhy():
	wrong = []
	for p in SOURCES:
		if 'plugin' not in p.relative_to(ROOT).parts: continue
		wrong += ['%s:%d: %d lines' % (p.relative_to(ROOT), n, length) for n, length, comment in longFunctions(p.read_text()) if 'Long because' not in comment]
	assert not wrong, 'more than %d lines and no "Long because ..." above:\n%s' % (LINES, '\n'.join(wrong))


def test_theTestSeesLongFunctions():
	body = '\n'.join('\tx++; // }' for _ in range(LINES + 1))
	assert [n for n, _, _ in longFunctions('struct A {\nvoid f(int x)\n{\n%s\n}\n};\n' % body)] == [2]
	assert longFunctions('/// Long because it is.\nvoid f(int x)\n{\n%s\n}\n' % body)[0][2] == '/// Long because it is.'
