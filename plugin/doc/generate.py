# SPDX-License-Identifier: GPL-2.0-or-later
"""Pages of the documentation that the program writes itself: class reference from the docstrings, examples, tables of exact values."""
import ast
import os
import re

HERE = os.path.dirname(os.path.abspath(__file__))
EXAMPLES = os.path.join(HERE, '..', '..', 'pyscripts', 'examples')
YADE_CLASS = 'https://yade-dem.org/doc/yade.wrapper.html#yade.wrapper.%s'


def escaped(text):
	return re.sub(r'([\\*`|_])', r'\\\1', text)


def plain(text):
	"""A plain docstring as reStructuredText: first paragraph as text, the rest as it stands."""
	head, _, rest = text.strip('\n').partition('\n\n')
	if not rest.strip() and '\n' not in head: return escaped(head) + '\n'
	if re.search(r'^\s', head, re.M): head, rest = '', text.strip('\n')
	return escaped(head) + '\n\n' + ('.. code-block:: none\n\n' + re.sub(r'^', '   ', rest.rstrip(), flags=re.M) + '\n' if rest.strip() else '')


def linked(text, own):
	"""Text of a class docstring with its :yref: as links, ours to this page and YADE's to YADE's."""
	out = []
	for k, part in enumerate(re.split(r':yref:`([^`]*)`', text)):
		if k % 2 == 0: out.append(escaped(part))
		elif part in own: out.append(':py:class:`%s`' % part)
		else: out.append('`%s <%s>`__' % (part, YADE_CLASS % part))
	return ''.join(out)


def attribute(doc):
	"""(text, default, type, flags) of a YADE attribute's docstring."""
	find = lambda tag: (re.search(r':%s:`([^`]*)`' % tag, doc) or [None, ''])[1]
	return re.sub(r':y(default|attrtype|attrflags):`[^`]*`', '', doc).strip(), find('ydefault'), find('yattrtype'), int(find('yattrflags') or 0)


def function(doc):
	"""(signature, text) of a docstring made by Boost.Python."""
	lines = [line.strip() for line in doc.strip().splitlines()]
	found = re.match(r'(\w+)\((.*?)\)\s*->\s*(\w+)', lines[0])
	if not found: return None, ' '.join(lines)
	arguments = re.sub(r'\((\w+)\)', '', found[2])
	arguments = [a.strip().strip('[').strip() for a in arguments.replace(']', '').split(',') if a.strip()]
	return '(%s)' % ', '.join(a for a in arguments if not a.startswith('arg1')), ' '.join(lines[1:])


def classPage(name, cls, own):
	base = next((c.__name__ for c in cls.__mro__[1:]), '')
	lines = [name, '-' * len(name), '', '.. py:class:: %s' % name, '']
	if base: lines += ['   Base: %s' % linked(':yref:`%s`' % base, own), '']
	lines += ['   ' + linked(' '.join(cls.__doc__.split()), own), '']
	for key, member in cls.__dict__.items():
		if key.startswith('_') or not member.__doc__: continue
		if isinstance(member, property):
			text, default, kind, flags = attribute(member.__doc__)
			lines += ['   .. py:attribute:: %s' % key]
			about = ', '.join(x for x in (escaped(kind), 'default %s' % escaped(default) if default and kind else '', 'read-only' if flags & 2 or not kind else '') if x)
			lines += ['', '      %s%s' % (linked(text, own), ' *(%s)*' % about if about else ''), '']
		else:
			signature, text = function(member.__doc__)
			lines += ['   .. py:method:: %s%s' % (key, signature or '()'), '', '      ' + linked(text, own), '']
	return lines


def classes(folder):
	import yade_mca
	lines = []
	for name in yade_mca.classes:
		lines += classPage(name, getattr(yade_mca, name), yade_mca.classes)
	write(folder, 'classes.rst', lines)


def examples(folder):
	lines = []
	for file in sorted(os.listdir(EXAMPLES)):
		if not file.endswith('.py'): continue
		path = os.path.join(EXAMPLES, file)
		with open(path) as f:
			doc = ast.get_docstring(ast.parse(f.read()))
		head, _, rest = doc.partition('\n')
		lines += [file, '-' * len(file), '', escaped(head), '']
		lines += ['.. code-block:: none', ''] + ['   ' + x for x in rest.strip().splitlines()] + ['']
		lines += ['.. literalinclude:: %s' % os.path.relpath(path, HERE), '   :language: python', '   :caption: pyscripts/examples/%s' % file, '']
		table = path[:-3] + '.table'
		if os.path.exists(table):
			lines += ['.. literalinclude:: %s' % os.path.relpath(table, HERE), '   :language: none', '   :caption: pyscripts/examples/%s' % os.path.basename(table), '']
	write(folder, 'examples.rst', lines)


def reflection(folder):
	from yade_mca import exact
	sizes, waves = (1, 2, 4), (10, 20, 40)
	lines = ['.. list-table:: Amplitude that comes back from a tied row, by wavelength', '   :header-rows: 1', '']
	rows = [['', *('%d d' % w for w in waves)]]
	for h in sizes:
		rows.append(['h = %d d' % h, *('%.4f' % exact.tiedRowReflection(float(w), float(h)) for w in waves)])
	for row in rows:
		lines += ['   %s - %s' % ('*' if k == 0 else ' ', cell) for k, cell in enumerate(row)]
	write(folder, 'reflection.rst', lines)


def materials(folder):
	from yade_mca import materials as library
	lines = ['.. list-table::', '   :header-rows: 1', '', *('   %s - %s' % ('*' if k == 0 else ' ', x) for k, x in enumerate(
	        ('name', 'density [kg/m3]', 'c0 [m/s]', 'b [-]', 'G [GPa]', 'yield model', 'sources: equation of state; strength')))]
	for name in library.names():
		m = library.get(name)
		row = (name, '%g' % m.density, '%g' % m.bulkSoundSpeed, '%g' % m.hugoniotSlope, '%g' % (1e-9 * m.shearModulus), m.yieldModel, '%s; %s' % (m.eosSource, m.strengthSource or 'none'))
		lines += ['   %s - %s' % ('*' if k == 0 else ' ', escaped(x)) for k, x in enumerate(row)]
	write(folder, 'materials.rst', lines)


def write(folder, name, lines):
	os.makedirs(folder, exist_ok=True)
	text = '\n'.join(lines) + '\n'
	path = os.path.join(folder, name)
	if not os.path.exists(path) or open(path).read() != text:
		with open(path, 'w') as f:
			f.write(text)


def everything(folder):
	for page in (classes, examples, reflection, materials):
		page(folder)
