# SPDX-License-Identifier: GPL-2.0-or-later
"""Plain line charts and stacked bars as SVG text for a page: colours and fonts come from the page's style (classes c0, c1, ...), so they follow its light and dark mode."""
import math
from html import escape

import numpy as np

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 560, 250, 62, 14, 12, 40
POINTS = 400  #: most points of one curve


def ticks(low, high, count=5):
	"""Round numbers from `low` to `high`, about `count` of them."""
	raw = (high - low) / count
	size = 10.**math.floor(math.log10(raw))
	step = next(size * k for k in (1, 2, 2.5, 5, 10) if size * k >= 0.75 * raw)
	first = math.ceil(low / step - 1e-9)
	return [k * step for k in range(first, math.floor(high / step + 1e-9) + 1)]


def span(arrays):
	"""Smallest and largest finite value of all, with some room."""
	every = np.concatenate([np.ravel(a) for a in arrays])
	every = every[np.isfinite(every)]
	low, high = (float(every.min()), float(every.max())) if len(every) else (0., 1.)
	room = 0.06 * (high - low) or 0.5 * abs(high) or 1.
	return low - (0 if low == 0 else room), high + room


def lines(x, curves, ylabel, xlabel, title, marks=(), colours=None):
	"""A chart of curves {name: (n,)} against x (n,). marks: ((x, text), ...) as upright lines. title: said by screen readers. colours: numbers of the classes, one per curve.

	Values that are not finite are left out.
	"""
	colours = colours or range(len(curves))
	x = np.asarray(x, float)
	(x0, x1), (y0, y1) = (float(x.min()), float(x.max()) if x.max() > x.min() else float(x.min()) + 1.), span(list(curves.values()))
	px = lambda v: LEFT + (v - x0) / (x1 - x0) * (WIDTH - LEFT - RIGHT)
	py = lambda v: HEIGHT - BOTTOM - (v - y0) / (y1 - y0) * (HEIGHT - TOP - BOTTOM)
	out = ['<svg viewBox="0 0 %d %d" role="img" aria-label="%s">' % (WIDTH, HEIGHT, escape(title, quote=True))]
	for v in ticks(y0, y1, 4):
		out.append('<path class="grid" d="M%d %.1fH%d"/><text x="%d" y="%.1f" text-anchor="end">%s</text>' % (LEFT, py(v), WIDTH - RIGHT, LEFT - 8, py(v) + 4, number(v)))
	for v in ticks(x0, x1, 7):
		out.append('<path class="tick" d="M%.1f %dv5"/><text x="%.1f" y="%d" text-anchor="middle">%s</text>' % (px(v), HEIGHT - BOTTOM, px(v), HEIGHT - BOTTOM + 18, number(v)))
	out.append('<path class="axis" d="M%d %dH%d"/>' % (LEFT, HEIGHT - BOTTOM, WIDTH - RIGHT))
	for at, text in marks:
		right = px(at) > 0.8 * WIDTH
		out.append('<path class="mark" d="M%.1f %dV%d"/><text class="note" x="%.1f" y="%d"%s>%s</text>' % (
		        px(at), TOP, HEIGHT - BOTTOM, px(at) + (-5 if right else 5), TOP + 9, ' text-anchor="end"' if right else '', escape(text)))
	every = max(1, math.ceil(len(x) / POINTS))
	for k, values in zip(colours, curves.values()):
		v = np.asarray(values, float)
		some = [i for i in range(len(x)) if np.isfinite(v[i]) and (i % every == 0 or i == len(x) - 1)]
		out.append('<polyline class="line c%d" points="%s"/>' % (k, ' '.join('%.1f,%.1f' % (px(x[i]), py(v[i])) for i in some)))
	out.append('<text class="label" x="%d" y="%d" text-anchor="end">%s</text>' % (WIDTH - RIGHT, HEIGHT - 4, escape(xlabel)))
	out.append('<text class="label" transform="translate(13 %d) rotate(-90)" text-anchor="middle">%s</text></svg>' % ((TOP + HEIGHT - BOTTOM) // 2, escape(ylabel)))
	return '\n'.join(out)


def bar(parts, title, colours=None):
	"""A stacked bar of shares {name: value >= 0}, in order; what is below 0 has no length. colours: numbers of the classes."""
	whole = sum(max(v, 0.) for v in parts.values()) or 1.
	out, at = ['<svg class="bar" viewBox="0 0 1000 46" preserveAspectRatio="none" role="img" aria-label="%s">' % escape(title, quote=True)], 0.
	for k, v in zip(colours or range(len(parts)), parts.values()):
		out.append('<rect class="fill c%d" x="%.2f" y="0" width="%.2f" height="46"/>' % (k, at, max(v, 0.) / whole * 1000))
		at += max(v, 0.) / whole * 1000
	return ''.join(out + ['</svg>'])


def swatch(colour):
	return '<i class="c%d" aria-hidden="true"></i>' % colour


def legend(names, colours=None):
	"""What the colours of the classes mean, as a list."""
	return '<ul class="legend">%s</ul>' % ''.join('<li>%s%s</li>' % (swatch(k), escape(n)) for k, n in zip(colours or range(len(names)), names))


def number(v):
	"""A tick's number, with a true minus and no exponent below a million."""
	return ('%.6g' % (0. if abs(v) < 1e-12 else v)).replace('-', '\u2212')
