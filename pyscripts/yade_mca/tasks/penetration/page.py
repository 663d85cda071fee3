# SPDX-License-Identifier: GPL-2.0-or-later
"""One page that shows a penetration run: animation, numbers beside the references, history, energy account, pictures, options, checks. HTML in one file without any reference to
other files or the network, so that it can be sent, kept and opened anywhere."""
import base64
import io
import math
import time
from html import escape
from pathlib import Path

from .. import environment, svg
from ..report import writeAtomically
from . import options
from . import report as results

STYLE = Path(__file__).with_name('page.css')
#: quantity -> how it is called on the page; others of results.DEFINITIONS that the record holds are shown by their own name
NAMES = {
        'lengthLoss': 'dl/l\u2080, intact rod',
        'lengthLossUnbroken': 'dl/l\u2080, head counted as rod',
        'lengthLossGeometric': 'dl/l\u2080, as a length',
        'velocityLossTail': 'dU/U\u2080, tail of the rod',
        'velocityLossAll': 'dU/U\u2080, all rod material',
}
ENERGIES = {'kinetic': 'kinetic', 'plastic': 'plastic work', 'viscous': 'viscosity', 'friction': 'friction', 'fracture': 'fracture', 'stored': 'stored in automata', 'grid': 'grid, internal'}
REST = 'pair coupling, boundaries'
COLOUR = {name: k for k, name in enumerate([*ENERGIES.values(), REST])}  #: classes of the style
CHECKS = {
        'energyError': 'energy, each kind computed on its own: change of the sum',
        'energyBooked': 'energy, work of all forces: change of the sum',
        'momentumBooked': 'momentum, impulses from outside counted: change',
        'automataLost': 'automata lost',
        'clamped': 'evaluations beyond the clamp of the equation of state',
        'deepest': 'smallest distance of two automata over their rest distance',
        'publishedLengthLoss': 'published dl/l\u2080: distance from the range here',
}
COLOURS = 128  #: of an embedded picture


def embedded(path, colours=None):
	"""A picture as data URI; with `colours` as a PNG of so many. None where the file cannot be read."""
	if not Path(path).is_file():  # a device might never end
		return None
	try:
		data = Path(path).read_bytes()
		if colours:
			from PIL import Image
			small = io.BytesIO()
			Image.open(io.BytesIO(data)).convert('RGB').quantize(colours, method=Image.FASTOCTREE, dither=0).save(small, 'PNG')
			data = small.getvalue()
	except OSError:
		return None
	return 'data:image/%s;base64,%s' % ('gif' if data[:3] == b'GIF' else 'png', base64.b64encode(data).decode())


def show(x, form='%.3f'):
	return '\u2013' if x is None or not math.isfinite(x) else (form % x).replace('-', '\u2212')


def table(head, rows):
	"""HTML table of rows (class, head of the row, cells...), all of them HTML already."""
	body = ''.join('<tr class="%s"><th scope="row">%s</th>%s</tr>' % (r[0], r[1], ''.join('<td>%s</td>' % c for c in r[2:])) for r in rows)
	return '<div class="card" tabindex="0"><table><thead><tr>%s</tr></thead><tbody>%s</tbody></table></div>' % (''.join('<th scope="col">%s</th>' % h for h in head), body)


def quantities(run):
	"""The reported quantities that the record holds, in the order of the definitions."""
	return [k for k in results.DEFINITIONS if k in run.record and k in NAMES] + [k for k in results.DEFINITIONS if k in run.record and k not in NAMES]


def losses(run, args, cases):
	"""Losses at the end, at the exit and at times others report, above published table, experiment and rod theory."""
	n, keys = results.name(args), quantities(run)
	rows = [('this', 'at the end, %.1f\u00a0\u00b5s' % (1e6 * run.time), run.last)]
	if run.exitTime is not None: rows.append(('', 'at the exit, %.1f\u00a0\u00b5s' % (1e6 * run.exitTime), run.at(run.exitTime)))
	rows += [('', 'at %d\u00a0\u00b5s' % us, run.at(1e-6 * us)) for us in (42, 80) if run.time >= 1e-6 * us]
	published = {k: cases[n + '/' + k].reference for k in ('lengthLoss', 'velocityLossTail') if n + '/' + k in cases}
	if any(v is not None for v in published.values()): rows.append(('other', 'published, Chertov et al. 2004', published))
	e = results.experiment()
	if args.thickness == e['thickness'] and results.normal(args): rows.append(('other', 'experiment, Fomin and Gulidov 1999', dict(lengthLoss=e['lengthLoss'], velocityLossTail=e['velocityLoss'])))
	t = results.tate(args.thickness, args.speed, args.rod_length, args.obliquity)
	rows.append(('other', 'rod theory, Alekseevskii\u2013Tate', dict(lengthLoss=t['lengthLoss'], velocityLossTail=t['velocityLoss'])))
	return table(['', *(escape(NAMES.get(k, k)).replace(', ', '<br>') for k in keys)], [(style, name, *(show(values.get(k)) for k in keys)) for style, name, values in rows])


def definitions(run):
	items = ''.join('<dt>%s</dt><dd>%s</dd>' % (escape(NAMES.get(k, k)), escape(results.DEFINITIONS[k])) for k in quantities(run))
	return '<details><summary>How these are defined</summary><dl>%s</dl></details>' % items


def account(run):
	"""Where the energy is at the end."""
	last, start = run.last, run.record['total'][0]
	parts = {name: last[k] for k, name in ENERGIES.items() if last.get(k)}
	parts[REST] = last['total'] - sum(parts.values())
	colours = [COLOUR[n] for n in parts]
	line = lambda head, v: ('', head, show(1e-3 * v, '%.1f'), show(100 * v / start, '%.2f'))
	rows = [line(svg.swatch(COLOUR[n]) + escape(n), v) for n, v in parts.items()] + [line('sum', last['total']), line('at the impact', start)]
	title = 'Energy at the end: ' + ', '.join('%s %.2f %%' % (n, 100 * v / start) for n, v in parts.items())
	return svg.bar(parts, title, colours) + table(('kind', 'kJ' if run.scene.facts.get('dimension') == 3 else 'kJ/m', '% of the impact energy'), rows)


def charts(run):
	"""The history as four charts."""
	r, e0 = run.arrays(), run.impactEnergy
	marks = [] if run.exitTime is None else [(1e6 * run.exitTime, 'exit')]
	loss = {NAMES.get(k, k): r[k] for k in quantities(run)}
	spent = {name: 100 * r[k] / e0 for k, name in ENERGIES.items() if k != 'kinetic' and abs(r[k]).max() > 0}
	panels = (('Velocity of the rod', 'm/s', {'tail': r['tailVelocity'], 'all rod material': r['allVelocity']}), ('Losses', '', loss),
	          ('Where the impact energy goes', '% of the impact energy', spent), ('Sum of all energies, change', '% of the impact energy', {'independent sum': 100 * (r['total'] - r['total'][0]) / e0}))
	out = []
	for title, unit, curves in panels:
		spoken = '%s against time: %s' % (title, '; '.join('%s from %s to %s %s' % (n, show(v[0], '%.4g'), show(v[-1], '%.4g'), unit) for n, v in curves.items()))
		colours = [COLOUR.get(n, k) for k, n in enumerate(curves)]
		drawn = svg.lines(1e6 * r['time'], curves, unit, 't [\u00b5s]', spoken, marks, colours)
		out.append('<figure class="chart"><figcaption>%s</figcaption>%s%s</figure>' % (escape(title), drawn, svg.legend(curves, colours) if len(curves) > 1 else ''))
	return '<div class="two">%s</div>' % ''.join(out)


def checks(args, report):
	"""What is asserted of every run, and whether it holds."""
	prefix, rows = results.name(args) + '/', []
	for c in report.cases:
		key = c.name[len(prefix):]
		if c.limit is None or not c.name.startswith(prefix): continue
		value = c.value if c.error is None else c.error
		least = key == 'deepest'
		rows.append(('', escape(CHECKS.get(key, key)), show(value, '%.2g'), ('\u2265 ' if least else '\u2264 ') + show(c.limit, '%.2g'),
		             '<span class="good">holds</span>' if c.passed else '<span class="bad">does not hold</span>'))
	return table(('', 'here', 'limit', ''), rows)


def chosen(args):
	"""All options, those that are not the default marked; and the command that makes the run again."""
	words, rows = ['pyscripts/run penetration'], []
	for name, (default, keywords) in options.SCENE.items():
		value = getattr(args, name.replace('-', '_'), None)
		if value is None: value = default
		changed = value != default and value is not None
		if changed: words.append('--%s %s' % (name, value if isinstance(value, str) else '%g' % value))
		text = '' if value is None else value if isinstance(value, str) else '%g' % value
		unit = {'MM': 'mm', 'M/S': 'm/s', 'DEG': '\u00b0'}.get(keywords.get('metavar'), '')
		rows.append(('changed' if changed else '', '<code>--%s</code>' % name, escape(text + (' ' + unit if unit and text else '')) or 'default', escape(str(keywords.get('help', '')))))
	if args.until is not None: words.append('--until %g' % args.until)
	body = table(('option', 'value', 'what it is'), rows).replace('<td>', '<td class="text">')
	return '<p>Made by <code>%s</code></p><details><summary>All options of the scene</summary>%s</details>' % (escape(' '.join(words)), body)


def facts(run, args, report, wall):
	"""What ran where."""
	last = run.last
	items = [('automata', '%d, spacing %g mm' % (run.count, args.spacing)), ('steps', '%d to %.1f \u00b5s; mean step %.3g ns' % (last['step'], 1e6 * run.time, 1e9 * run.time / max(last['step'], 1))),
	         ('ended', run.reason), ('links broken', '%d' % last['brokenLinks']), ('time', '%.1f s in all, %.1f s in steps, %d threads' % (wall, run.stepSeconds, environment.threads())),
	         ('processor', '%s, instructions %s' % (environment.processor() or 'unknown', environment.isa() or 'unknown')),
	         ('program', 'yade-mca %s, commit %s' % (environment.version(), environment.commit() or 'unknown')), ('written', time.strftime('%Y-%m-%d %H:%M %Z'))]
	return '<div class="card"><dl style="margin:0">%s</dl></div>' % ''.join('<dt>%s</dt><dd>%s</dd>' % (escape(k), escape(v)) for k, v in items)


def title(args):
	oblique = ', %g\u00b0 oblique' % args.obliquity if args.obliquity else ''
	return '%g mm plate, %g \u00d7 %g mm rod, %g m/s%s' % (args.thickness, args.rod_diameter, args.rod_length, args.speed, oblique)


def tiles(run):
	last = run.last
	items = [(show(last['lengthLoss']), 'dl/l\u2080, rod eroded'), (show(last['velocityLossTail']), 'dU/U\u2080 of the tail'), (show(last['velocityLossAll']), 'dU/U\u2080 of all rod material'),
	         ('%.0f m/s' % last['tailVelocity'] if math.isfinite(last['tailVelocity']) else '\u2013', 'velocity of the tail at the end'),
	         ('\u2013' if run.exitTime is None else '%.1f \u00b5s' % (1e6 * run.exitTime), 'exit of the head')]
	return '<div class="tiles">%s</div>' % ''.join('<div class="tile"><b>%s</b><span>%s</span></div>' % i for i in items)


def hero(folder, run, args):
	"""The animation, standing still for those who want no motion; nothing where there is none."""
	alt = 'A rod of %g x %g mm goes through a plate of %g mm from left to right, coloured by plastic strain; the rod loses %.0f %% of its length' % (
	        args.rod_diameter, args.rod_length, args.thickness, 100 * run.last['lengthLoss'])
	moving = None if args.no_animation else embedded(folder / 'penetration.gif')
	frames = sorted((folder / 'frames').glob('frame_*.png'))
	if moving and frames:
		image = '<picture><source media="(prefers-reduced-motion: reduce)" srcset="%s"><img src="%s" alt="%s"></picture>' % (embedded(frames[-1]), moving, escape(alt, quote=True))
		return '<figure>%s<figcaption>Plastic strain in rod and plate, %.1f \u00b5s from the impact on. Cells of the grid are drawn with their mesh.</figcaption></figure>' % (image, 1e6 * run.time)
	return ''


def pictures(folder):
	"""Plastic strain and pressure at the times that were drawn."""
	out = []
	for path in sorted(folder.glob('pattern_*.png')):
		data = embedded(path, COLOURS)
		when = 'at the end' if path.stem == 'pattern_end' else 'at %d \u00b5s' % int(path.stem[8:-2])
		if data: out.append('<figure><img src="%s" alt="Plastic strain (left) and pressure (right) %s"><figcaption>Plastic strain and pressure %s</figcaption></figure>' % (data, when, when))
	return '<h2>Pattern</h2><div class="two">%s</div>' % ''.join(out) if out else ''


def page(run, args, report, folder, wall):
	"""The whole page as text. folder: where the pictures of the run are; what is not there is left out."""
	cases, f, folder = {c.name: c for c in report.cases}, run.scene.facts, Path(folder)
	mode = 'automata tied to a grid' if args.mode == 'coupled' else 'automata only'
	return '\n'.join([
	        '<!DOCTYPE html>', '<html lang="en">', '<head>', '<meta charset="utf-8">', '<meta name="viewport" content="width=device-width, initial-scale=1">',
	        '<meta http-equiv="Content-Security-Policy" content="default-src \'none\'; img-src data:; style-src \'unsafe-inline\'">',
	        '<title>%s</title>' % escape(title(args)), '<style>', STYLE.read_text(), '</style>', '</head>', '<body>', '<header>', '<h1>%s</h1>' % escape(title(args)),
	        '<p class="soft">Penetration in plane strain: rod of %s, plate of %s, %s, ends of the plate %s, spacing %g mm. yade-mca %s.</p>' % (
	                escape(f['rod']), escape(f['plate']), mode, escape(f['ends']), args.spacing, escape(str(environment.version()))), '</header>', '<main>', hero(folder, run, args), tiles(run),
	        '<h2>Losses</h2>', losses(run, args, cases), definitions(run), '<h2>History</h2>', charts(run), '<h2>Energy</h2>', account(run), '<h2>Checks</h2>', checks(args, report), pictures(folder),
	        '<h2>Run</h2>', chosen(args), facts(run, args, report, wall), '</main>',
	        '<footer>Lengths, masses and energies are per 1 m of thickness. To cite: YADE (doi 10.5281/zenodo.5705394) and yade-mca with its version. The same numbers are in summary.json.</footer>', '</body>',
	        '</html>', ''])


def write(path, run, args, report, folder, wall):
	"""Writes the page; raises OSError."""
	writeAtomically(str(path), page(run, args, report, folder, wall))
	return str(path)
