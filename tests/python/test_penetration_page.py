# SPDX-License-Identifier: GPL-2.0-or-later
"""Animation and page of a penetration run: frames show what is where, the GIF holds them, the page is one file without the network and looks right in a browser."""
import base64
import io
import json
import os
import re
import shutil
import subprocess
from html.parser import HTMLParser
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from PIL import Image, ImageSequence

from yade_mca import frames
from yade_mca.tasks import svg

PACKAGE = Path(__file__).resolve().parents[2] / 'pyscripts'
BOUNDS = (-0.05, -0.1, 0.05, 0.1)


@pytest.fixture(scope='module')
def folder(tmp_path_factory):
	"""The files of a coarse run."""
	out = tmp_path_factory.mktemp('run')
	env = dict(os.environ, OMP_NUM_THREADS='1', PYTHONPATH=str(PACKAGE))
	done = subprocess.run(['/usr/bin/python3', '-m', 'yade_mca.tasks', 'penetration', '--spacing', '2', '--thickness', '16', '--until', '12', '--friction', '0.2', '--out', str(out)],
	                      env=env, capture_output=True, text=True, timeout=600)
	assert done.returncode == 0, done.stderr
	return out


def colours(image):
	return np.array(image.convert('RGB')).astype(int)


def near(pixels, colour, by=12):
	"""How many pixels (..., 3) have a colour, to within `by` in each channel."""
	return int((abs(pixels - frames.rgb(colour)).max(axis=-1) <= by).sum())


# ---- frames


def test_aFrameShowsWhatIsWhere():
	painter = frames.Painter(BOUNDS, width=800)  # 4 pixels per mm
	place = np.array([[0.02, 0.03], [-0.02, -0.03]])
	p = colours(painter.frame([(place, np.full(2, 4e-3), frames.shade(np.array([0., 10.]), 1))]))
	assert p.shape == (400 + painter.HEAD + painter.FOOT, 800, 3)
	row = lambda x: painter.HEAD + round((0.05 - x) * 4000)
	column = lambda y: round((0.1 - y) * 4000)
	assert np.array_equal(p[row(0.02), column(0.03)], frames.rgb(frames.ROD[0])) and np.array_equal(p[row(-0.02), column(-0.03)], frames.rgb(frames.ROD[-1]))
	view = p[painter.HEAD:-painter.FOOT]
	drawn = (view != 255).any(axis=2).sum()
	assert 1 < drawn / (2 * np.pi * (0.58 * 16)**2) < 1.2  # discs that cover the cell of an automaton
	assert np.array_equal(p[row(0.02), column(-0.03)], [255, 255, 255])


def test_aPackingAndAGridCoverTheirArea():
	from yade_mca.packings import Rectangle, hexagonal
	painter = frames.Painter(BOUNDS, width=800)
	inside = slice(painter.HEAD + 140, painter.HEAD + 260), slice(340, 460)
	p = hexagonal(2e-3, Rectangle((0, 0), (60e-3, 60e-3))).positions
	assert near(colours(painter.frame([(p, np.full(len(p), 2e-3), frames.shade(np.zeros(len(p)), 17))]))[inside], frames.PLATE[0]) == 14400
	nodes = np.stack(np.meshgrid(np.linspace(-0.03, 0.03, 121), np.linspace(-0.03, 0.03, 121), indexing='ij'), axis=-1)
	assert near(colours(painter.frame([], [(nodes, frames.shade(np.zeros((120, 120)), 17))]))[inside], frames.PLATE[0]) == 14400
	coarse = colours(painter.frame([], [(nodes[::10, ::10], frames.shade(np.zeros((12, 12)), 17))]))[inside]
	assert near(coarse, frames.PLATE[0]) == (120 - 6)**2  # all but six lines of the mesh each way
	assert (coarse < 250).any(axis=2).all()


def test_outsideTheViewNothingIsDrawn():
	painter = frames.Painter(BOUNDS, width=600)
	far = np.array([[1., 1.], [-1., 0.], [0., 5.], [0.0499, 0.0999]])
	image = painter.frame([(far, np.full(4, 2e-3), frames.shade(np.zeros(4), 1))])
	assert image.size == (600, 300 + painter.HEAD + painter.FOOT)


def test_whichFramesThereAreDependsOnTheTimesAlone(tmp_path, monkeypatch):
	monkeypatch.setattr(frames, 'paint', lambda painter, run: Image.new('P', (4, 4)))
	at = lambda t: SimpleNamespace(time=t)
	times = np.cumsum(np.random.default_rng(1).uniform(0.5e-6, 1.5e-6, 400))
	whole = frames.Frames(tmp_path / 'a', BOUNDS, 1e-6)
	for t in times:
		whole.update(at(t))
	names = sorted(f.name for f in (tmp_path / 'a').iterdir())
	assert names == [f.name for _, f in sorted(whole.files.items())] and frames.COUNT / 2 <= len(names) <= frames.COUNT
	gaps = np.diff([int(n[6:-4]) for n in names])
	assert gaps.max() < 2.2 * np.median(gaps)
	first = frames.Frames(tmp_path / 'b', BOUNDS, 1e-6)
	for t in times[:250]:
		first.update(at(t))
	there = [f.name for f in sorted((tmp_path / 'b').iterdir())]
	resumeAt = 1e-9 * int(there[-9][6:-4])  # a checkpoint that follows a frame at once
	again = frames.Frames(tmp_path / 'c', BOUNDS, 1e-6, resumeAt=resumeAt)
	assert again.files == {}
	for name in there: (tmp_path / 'c' / name).write_bytes((tmp_path / 'b' / name).read_bytes())
	assert [f.name for f in frames.Frames(tmp_path / 'c', BOUNDS, 1e-6, resumeAt=resumeAt).files.values()] == there[:-8]
	again = frames.Frames(tmp_path / 'b', BOUNDS, 1e-6, resumeAt=times[200])
	for t in times[200:]:
		again.update(at(t))
	assert sorted(f.name for f in (tmp_path / 'b').iterdir()) == names
	assert frames.Frames(tmp_path / 'b', BOUNDS, 1e-6).files == {} and os.listdir(tmp_path / 'b') == []  # another run


def test_theGifHoldsTheFramesToThePixel(folder):
	kept = sorted((folder / 'frames').iterdir())
	with Image.open(folder / 'penetration.gif') as gif:
		assert gif.n_frames == len(kept) > 5 and gif.info['loop'] == 0
		for shown, f in zip(ImageSequence.Iterator(gif), kept):
			assert np.array_equal(colours(shown), colours(Image.open(f))), f
	assert (folder / 'penetration.gif').stat().st_size < frames.LARGEST


def test_aGifThatIsTooLargeKeepsItsLastFrame(tmp_path):
	noise = np.random.default_rng(1).integers(0, 200, (40, 50, 50)).astype(np.uint8)
	images = [Image.fromarray(n, 'P') for n in noise]
	for i in images: i.putpalette(frames.palette().tobytes())
	frames.writeGif(tmp_path / 'a.gif', images, largest=50000)
	with Image.open(tmp_path / 'a.gif') as gif:
		assert 5 <= gif.n_frames < 25
		gif.seek(gif.n_frames - 1)
		assert np.array_equal(colours(gif), colours(images[-1]))


def test_paletteHasRoom():
	assert frames.INK + frames.COVER <= frames.CLEAR and len({tuple(c) for c in frames.palette()[:frames.INK + frames.COVER].tolist()}) > 120


# ---- page


class Reader(HTMLParser):
	"""Checks that tags close and gathers what the page refers to and says."""
	EMPTY = {'meta', 'img', 'source', 'br'}

	def __init__(self, text):
		super().__init__()
		self.open, self.refers, self.images, self.words = [], [], [], []
		self.feed(text)

	def handle_starttag(self, tag, attributes):
		a = dict(attributes)
		self.refers += [v for k, v in a.items() if k in ('src', 'href', 'srcset', 'data', 'action', 'poster')]
		if tag in ('img', 'svg'): self.images.append((tag, a))
		if tag not in self.EMPTY: self.open.append(tag)

	def handle_startendtag(self, tag, attributes):
		self.handle_starttag(tag, attributes)
		if tag not in self.EMPTY: self.open.pop()

	def handle_endtag(self, tag):
		assert self.open.pop() == tag, tag

	def handle_data(self, data):
		self.words.append(data)


def test_thePageIsOneFileWithoutTheNetwork(folder):
	text = (folder / 'penetration.html').read_text()
	page = Reader(text)
	assert page.open == [] and len(page.refers) >= 4
	assert all(r.startswith('data:image/') for r in page.refers), [r[:40] for r in page.refers]
	assert not re.search(r'https?:|//\w|url\(|@import|<script|<link', re.sub(r'data:image/\w+;base64,[\w+/=]+', '', text))
	assert "default-src 'none'" in text and 'name="viewport"' in text and 'lang="en"' in text and 'prefers-color-scheme: dark' in text and 'prefers-reduced-motion' in text
	assert len(text) < 4e6
	for r in page.refers:
		Image.open(io.BytesIO(base64.b64decode(r.split(',')[1]))).load()


def test_everyPictureIsSaidInWords(folder):
	images = Reader((folder / 'penetration.html').read_text()).images
	assert {'img', 'svg'} == {t for t, _ in images} and len(images) >= 7
	for tag, a in images:
		assert len(a['alt' if tag == 'img' else 'aria-label']) > 20, (tag, a.get('alt'))


def test_thePageSaysTheNumbersOfTheRun(folder):
	found = json.loads((folder / 'summary.json').read_text())
	words = ' '.join(' '.join(Reader((folder / 'penetration.html').read_text()).words).split())
	for case in ('lengthLoss', 'lengthLossUnbroken', 'velocityLossTail', 'velocityLossAll'):
		assert '%.3f' % next(c['value'] for c in found['cases'] if c['name'] == 'T16/coupled/' + case) in words, case
	assert found['version'] in words and found['commit'] in words
	assert 'pyscripts/run penetration --thickness 16 --spacing 2 --friction 0.2 --until 12' in words
	record = found['penetration']['record']
	for kind in ('kinetic', 'plastic', 'viscous', 'total'):
		assert '%.1f' % (1e-3 * record[kind][-1]) in words, kind
	assert words.count('holds') == sum(c['limit'] is not None for c in found['cases']) >= 6
	assert set(found['penetration']['processorSecondsOfFiles']) == {'animation', 'page'}


def test_withoutAnimationAndPage(plugin, tmp_path):
	from yade_mca.tasks import cli
	scene = ['penetration', '--spacing', '4', '--thickness', '16', '--until', '3', '--out']
	assert cli.main([*scene, str(tmp_path / 'a'), '--no-animation']) == 0
	assert not (tmp_path / 'a' / 'penetration.gif').exists() and not (tmp_path / 'a' / 'frames').exists()
	page = Reader((tmp_path / 'a' / 'penetration.html').read_text())
	assert page.open == [] and not [r for r in page.refers if r.startswith('data:image/gif')]
	assert cli.main([*scene, str(tmp_path / 'b'), '--no-page']) == 0
	assert (tmp_path / 'b' / 'penetration.gif').exists() and not (tmp_path / 'b' / 'penetration.html').exists()


def browser():
	for name in ('chromium', 'chromium-browser', 'chromium-headless-shell', 'google-chrome'):
		if shutil.which(name): return name
	pytest.skip('no Chromium to look at the page with: apt-get install chromium')


def screenshot(path, width, height, tmp_path, *options):
	"""What the browser shows, (height, width, 3)."""
	target = tmp_path / 'shot.png'
	done = subprocess.run([browser(), '--headless', '--no-sandbox', '--disable-gpu', '--hide-scrollbars', '--no-first-run', '--disable-background-networking', '--user-data-dir=%s' % (tmp_path / 'profile'),
	                       '--window-size=%d,%d' % (width, height), '--screenshot=%s' % target, *options, path.resolve().as_uri()], capture_output=True, text=True, timeout=300, env=dict(os.environ, HOME=str(tmp_path)))
	assert target.exists(), done.stderr[-2000:]
	return colours(Image.open(target))


def test_theBrowserShowsRodAndPlate(folder, tmp_path):
	p = screenshot(folder / 'penetration.html', 1100, 1700, tmp_path)
	assert p.shape == (1700, 1100, 3)
	assert near(p, frames.ROD[0]) > 5000 and near(p, frames.PLATE[0]) > 5000, 'the animation is not there'
	assert near(p, '#1f6fb4', 4) > 300 and near(p, '#d9562b', 4) > 300, 'the charts are not there'
	assert near(p, '#f5f6f8', 2) > 100000 and near(p, '#1d2733', 40) > 1000, 'no page, or no text'


def test_theBrowserShowsItOnAPhoneInTheDark(folder, tmp_path):
	p = screenshot(folder / 'penetration.html', 500, 2400, tmp_path, '--force-dark-mode')
	assert near(p, '#11161c', 2) > 30000 and near(p, '#1a2129', 2) > 100000 and near(p, '#f5f6f8', 2) < 20000, 'not dark'
	assert near(p, frames.ROD[0]) > 1000 and near(p, '#58a6e8', 4) > 100
	assert (abs(p[:, -6:] - frames.rgb('#11161c')).max() <= 2), 'something is wider than the screen'


# ---- charts


def test_ticksAreRoundAndInside():
	assert svg.ticks(0, 10) == [0, 2, 4, 6, 8, 10] and svg.ticks(-0.04, 0.05, 4) == pytest.approx([-0.04, -0.02, 0, 0.02, 0.04]) and len(svg.ticks(1311., 1520., 4)) in (3, 4, 5)


def test_chartsOfEdgeCases():
	for v in (np.zeros(3), np.full(3, np.nan), np.array([1., np.nan, 2.]), np.array([-1e9, 0, 1e9])):
		text = svg.lines([0, 1, 2], {'<a>': v}, 'y & z', 'x', 'a "title"')
		Reader(text)
		assert 'nan' not in text and '<a>' not in text and text.count('<polyline') == 1
	text = svg.lines(np.arange(10000), {'a': np.arange(10000.)}, 'y', 'x', 'long')
	assert len(text) < 20000 and re.search(r'%.1f,[\d.]+"/>' % (svg.WIDTH - svg.RIGHT), text)  # thinned; the last point is there
	assert svg.bar({'a': 3., 'b': 1., 'c': -1.}, 'shares').count('width="750.00"') == 1
