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


# what names a component: r.x, perMassX, tiedVx, vx (but not the word by), txy
COMPONENT = re.compile(r'(\.|->)[xyz]\b|[a-z0-9][XYZ]\b|[a-z][A-Z][xyz]\b|\b(?!by\b)[a-z][xy]\b|\b[a-z]?(xx|xy|yx|yy)\b')


def namesComponents(text):
	return [n for n, line in enumerate(text.split('\n'), 1) if not line.startswith('#') and COMPONENT.search(bare(line))]


def test_onlyTheVectorKnowsItsComponents():
	sources = [p for p in SOURCES if ROOT / 'plugin' / 'automata' in p.parents and p.name != 'fields.hpp']  # its rows hold the names for scripts and files
	assert len(sources) > 20
	wrong = ['%s:%d' % (p.relative_to(ROOT), n) for p in sources for n in namesComponents(p.read_text())]
	assert not wrong, 'components of vectors are named; loop over `dim` of them or use Vec and Vectors:\n%s' % '\n'.join(wrong)


def test_theTestSeesComponents():
	for line in ('r.x', 'a->y', 'S.perMassX[i] = 0;', 'impulseY += 1;', 'double vx = 0;', 'fy[i]', 'const double dx = 1;', 'S.px', 'tiedVx[t]', 'push.xy', 'scratch.volX'):
		assert namesComponents('\t' + line) == [1], line
	for line in ('double x = 1; // not .x', '"%s.x"', 'r.xs', 'max(x, y)', 'S.szz[i]', 'index', 'axis', 'S.position[c][i]', 'nextY2', 'clock.by'):
		assert not namesComponents('\t' + line), line
