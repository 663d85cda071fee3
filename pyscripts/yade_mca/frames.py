# SPDX-License-Identifier: GPL-2.0-or-later
"""Animation of a penetration run: small frames, painted straight into palette indices, and the GIF made of them.

A frame shows rod and plate in two colour ramps, lighter (rod) or redder (plate) with plastic strain; the impact goes from left to right. Each costs about as much as a few
steps of a coarse run. They are kept as PNG files, so that a run that goes on from a checkpoint has those from before, and so few that the GIF stays below a megabyte.
"""
import os
import re
from pathlib import Path

import numpy as np

__all__ = ['Frames', 'Painter', 'frameNumber', 'writeGif']

WIDTH = 760  #: of a frame [pixels]
COUNT = 80  #: most frames of one run; beyond, every second one goes
SHADES = 16  #: of each material
LARGEST = 1000000  #: size of the GIF [bytes]
CLEAR = 255  #: index of what stays as it was in the frame before
STRAIN = 1.5  #: plastic strain of the last shade [-]
ROD = ('#14365f', '#1f6fb4', '#39a7dc', '#9be3f5')  #: colours from no plastic strain to STRAIN
PLATE = ('#a9b0b7', '#d9a066', '#d9562b', '#8f1d14')
BACKGROUND, TEXT = '#ffffff', '#1d2733'
LINE = 2 * SHADES + 1  #: shade of the lines between cells of the grid
COVER = 4  #: subpixels of a pixel, so degrees of covering: edges are smooth without more colours than a GIF holds
INK = 1 + LINE * COVER  #: first of the indices of text


def rgb(colour):
	"""(3,) of '#rrggbb'."""
	return np.array([int(colour[k:k + 2], 16) for k in (1, 3, 5)], float)


def ramp(colours, count):
	"""Colours (count, 3) along straight lines between the given ones."""
	stops = np.array([rgb(c) for c in colours])
	at = np.linspace(0, len(stops) - 1, count)
	return np.stack([np.interp(at, np.arange(len(stops)), stops[:, k]) for k in range(3)], axis=1)


def palette():
	"""The 256 colours of all frames, (256, 3) uint8: 0 background, 1 + 4 (shade - 1) + (covered subpixels - 1), then text."""
	back, colours = rgb(BACKGROUND), np.concatenate((ramp(ROD, SHADES), ramp(PLATE, SHADES), [rgb('#7d858d')]))
	share = np.arange(1, COVER + 1)[:, None] / COVER
	rows = [back] + [c * s + back * (1 - s) for c in colours for s in share] + [rgb(TEXT) * s + back * (1 - s) for s in share]
	full = np.zeros((256, 3))
	full[:len(rows)] = rows
	return np.round(full).astype(np.uint8)


def shade(strain, first):
	"""Shades of plastic strains; `first` is that of no strain."""
	return (first + np.clip(np.asarray(strain) / STRAIN * (SHADES - 1) + 0.5, 0, SHADES - 1).astype(np.uint8)).astype(np.uint8)


class Painter:
	"""Paints automata and cells of one view. bounds (x0, y0, x1, y1) [m] of the scene; they are turned by a right angle: -y goes to the right, x up. width: from 560 pixels on."""

	HEAD, FOOT = 34, 44  #: pixels above and below the view

	def __init__(self, bounds, width=WIDTH):
		from PIL import ImageFont
		from matplotlib.font_manager import findfont
		x0, y0, x1, y1 = bounds
		self.scale = width / (y1 - y0)  #: pixels per metre
		self.origin = np.array([y1, x1])
		self.size = (width, 2 * (round((x1 - x0) * self.scale) // 2))
		font = findfont('DejaVu Sans')
		self.fonts = {size: ImageFont.truetype(font, size) for size in (13, 17)}
		self.table = np.zeros((COVER + 1, LINE + 1), np.uint8)
		self.table[1:, 1:] = 1 + COVER * np.arange(LINE)[None, :] + np.arange(COVER)[:, None]
		self.palette = palette().tobytes()
		self.still = None

	def pixels(self, points):
		"""Places (..., 2) in subpixels, half a pixel each, of points (..., 2) [m]."""
		p = np.asarray(points, float)
		return 2 * self.scale * (self.origin - p[..., ::-1])

	def frame(self, bodies, grids=(), text=''):
		"""One frame, PIL image of palette indices.

		bodies: (positions (N, 2) [m], diameter (N,) [m], shades (N,)); grids: (nodes (ni, nj, 2) [m], shades (ni-1, nj-1)); text: what stands above
		"""
		from PIL import Image, ImageDraw
		canvas = np.zeros((2 * self.size[1], 2 * self.size[0]), np.uint8)
		if grids:
			image = Image.fromarray(canvas)
			draw = ImageDraw.Draw(image)
			for nodes, shades in grids:
				self._cells(draw, self.pixels(nodes), shades)
			canvas = np.array(image)
		for positions, diameter, shades in bodies:
			self._discs(canvas, self.pixels(positions), 2 * self.scale * np.asarray(diameter), shades)
		parts = [canvas[i::2, k::2] for i in (0, 1) for k in (0, 1)]
		cover = sum((p > 0).astype(np.uint8) for p in parts)
		view = self.table[cover, np.maximum(np.maximum(parts[0], parts[1]), np.maximum(parts[2], parts[3]))]
		whole = np.zeros((self.size[1] + self.HEAD + self.FOOT, self.size[0]), np.uint8)
		whole[self.HEAD:-self.FOOT] = view
		if self.still is None:
			self.still = self._legend(whole.shape)
		ink = self._ink(whole.shape[1], self.HEAD, [(12, 8, 17, text)])
		whole[:self.HEAD] = np.where(ink > 0, ink, whole[:self.HEAD])
		whole = np.where(self.still > 0, self.still, whole)
		image = Image.fromarray(whole, 'P')
		image.putpalette(self.palette)
		return image

	def _discs(self, canvas, centres, diameter, shades):
		for d in np.unique(np.round(diameter, 3)):
			some = np.abs(diameter - d) < 1e-3
			r = max(0.58 * d, 0.5) + 0.25  # discs of d/sqrt(3) cover a whole packing
			k = np.arange(-int(np.ceil(r)), int(np.ceil(r)) + 1)
			dy, dx = np.meshgrid(k, k, indexing='ij')
			inside = dx**2 + dy**2 <= r * r
			at = np.floor(centres[some]).astype(int)
			x, y = at[:, :1] + dx[inside], at[:, 1:] + dy[inside]
			seen = (x >= 0) & (x < canvas.shape[1]) & (y >= 0) & (y < canvas.shape[0])
			canvas[y[seen], x[seen]] = np.broadcast_to(shades[some][:, None], x.shape)[seen]

	def _cells(self, draw, nodes, shades):
		corners = np.stack((nodes[:-1, :-1], nodes[1:, :-1], nodes[1:, 1:], nodes[:-1, 1:]), axis=2)
		edges = np.linalg.norm(corners - np.roll(corners, 1, axis=2), axis=-1)
		lines = LINE if edges.mean(axis=(0, 1)).min() > 5 else None  # finer meshes would be lines only
		for c, s in zip(corners.reshape(-1, 8).tolist(), shades.ravel().tolist()):
			draw.polygon(c, fill=s, outline=lines or s)

	def _ink(self, width, height, words):
		"""Indices of text (height, width), 0 where there is none; words: (x, y, size, text)."""
		from PIL import Image, ImageDraw
		mask = Image.new('L', (width, height))
		draw = ImageDraw.Draw(mask)
		for x, y, size, text in words:
			draw.text((x, y), text, fill=255, font=self.fonts[size])
		degree = (np.array(mask).astype(int) * COVER + 127) // 255
		return np.where(degree > 0, INK + degree - 1, 0).astype(np.uint8)

	def _legend(self, shape):
		"""What all frames share: ramps with their names, scale."""
		height, width = shape
		still = np.zeros(shape, np.uint8)
		top, bar = height - self.FOOT + 14, 110
		words, x = [], 12
		for name, first in (('rod', 1), ('plate', 1 + SHADES)):
			words.append((x, 12, 13, name))
			x += 10 + self.fonts[13].getbbox(name)[2]
			still[top:top + 14, x:x + bar] = self.table[COVER, shade(np.linspace(0, STRAIN, bar), first)]
			x += bar + 22
		words.append((x - 8, 12, 13, 'plastic strain 0 to %g' % STRAIN))
		longest = 120 * width / WIDTH / self.scale  # of the scale: a round length of at most some 120 pixels [m]
		length = max(k * 10.**e for e in range(-9, 3) for k in (1, 2, 5) if k * 10.**e <= longest)
		start, name = int(width - 14 - length * self.scale), '%g mm' % (1e3 * length)
		still[top + 5:top + 8, start:start + round(length * self.scale)] = INK + COVER - 1
		words.append((start - 8 - self.fonts[13].getbbox(name)[2], 12, 13, name))
		ink = self._ink(width, self.FOOT, words)
		still[-self.FOOT:] = np.where(ink > 0, ink, still[-self.FOOT:])
		return still


def gif(images, seconds=6., hold=1.5):
	"""Images of the palette above as the bytes of a GIF that repeats for ever: `seconds` for all, the last one `hold` seconds longer."""
	import io

	from PIL import Image
	each = max(20, 10 * round(100 * seconds / len(images)))
	changes, before = [], None
	for image in images:
		now = np.array(image)
		changed = Image.fromarray(now if before is None else np.where(now == before, CLEAR, now).astype(np.uint8), 'P')
		changed.putpalette(palette().tobytes())
		changes.append(changed)
		before = now
	data = io.BytesIO()
	changes[0].save(data, 'GIF', save_all=True, append_images=changes[1:], loop=0, duration=[each] * (len(images) - 1) + [each + round(1e3 * hold)], disposal=1, transparency=CLEAR, optimize=False)
	return data.getvalue()


def writeGif(path, images, largest=LARGEST):
	"""Writes images of the palette above as a GIF, with every second one left out while it is above `largest` bytes. The file appears whole or not at all; raises OSError."""
	from .tasks.report import writeAtomically
	data = gif(images)
	while len(data) > largest and len(images) > 10:
		images = images[len(images) % 2 == 0::2]  # the last one stays
		data = gif(images)
	writeAtomically(str(path), data)
	return str(path)


def frameNumber(nanoseconds, interval):
	"""In which interval [s] a time lies."""
	return int((1e-9 * nanoseconds + 1e-12) / interval)


class Frames:
	"""The frames of one run in a folder, named by their time in ns; which ones there are depends on the times of the samples alone."""

	NAME = re.compile(r'frame_(\d+)\.png')

	def __init__(self, folder, bounds, interval, resumeAt=None):
		"""interval: least time between frames [s]; resumeAt: time of the checkpoint of a run that goes on [s]: later frames are forgotten; that of its own time was drawn before it."""
		self.folder, self.interval = Path(folder), interval
		self.folder.mkdir(exist_ok=True)
		self.painter = Painter(bounds)
		self.files = {}
		for f in sorted(self.folder.iterdir()):
			match = self.NAME.fullmatch(f.name)
			if match and resumeAt is not None and 1e-9 * int(match[1]) < resumeAt + 0.5e-9:
				self.files[int(match[1])] = f
			elif match or f.name.startswith('.frame_'):
				f.unlink()
		self.last = max(map(self.number, self.files), default=-1)

	def number(self, nanoseconds):
		"""In which interval a time lies."""
		return frameNumber(nanoseconds, self.interval)

	def update(self, still):
		"""Paints a frame of an impact_output.Still when one is due. Raises OSError."""
		time = round(1e9 * still.time)
		if self.number(time) <= self.last:
			return
		self.last = self.number(time)
		path = self.folder / ('frame_%07d.png' % time)
		image = paint(self.painter, still)
		part = path.with_name('.' + path.name)
		try:  # renamed when whole, but not flushed to the disk: it is only a picture
			image.save(part, 'PNG', compress_level=3)
			os.replace(part, path)
		except OSError as e:
			part.unlink(missing_ok=True)
			raise OSError(e.errno, e.strerror or str(e), str(path)) from e
		self.files[time] = path
		self._thin()

	def _thin(self):
		while self.last >= COUNT:
			self.interval *= 2
			first = {}
			for time in sorted(self.files):
				if first.setdefault(self.number(time), time) != time:
					self.files.pop(time).unlink(missing_ok=True)
			self.last = self.number(max(self.files))

	def images(self):
		"""All frames in order; one that cannot be read, as after a crash of the machine, is left out."""
		from PIL import Image
		found = []
		for _, f in sorted(self.files.items()):
			try:
				with Image.open(f) as image:
					image.load()
				found.append(image)
			except (OSError, SyntaxError):
				continue
		return found


def paint(painter, still):
	"""The frame of an impact_output.Still."""
	rod, strain = still.fields['rod'] > 0, still.fields['plasticStrain']
	bodies = [(still.positions[some], 2 * still.radius[some], shade(strain[some], first)) for some, first in ((~rod, 1 + SHADES), (rod, 1))]
	grids = [(nodes, shade(cells['plasticStrain'], 1 + SHADES)) for nodes, cells, _ in still.grids.values()]
	return painter.frame(bodies, grids, still.text)
