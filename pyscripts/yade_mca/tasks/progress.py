# SPDX-License-Identifier: GPL-2.0-or-later
"""Progress of a task: a bar on a terminal, a plain line now and then elsewhere."""
import sys
import time


class Progress:
	"""progress.update(done, energyError=1e-12) with `done` out of `total`; use as a context manager."""
	INTERVAL = 10.  # seconds between plain lines

	def __init__(self, total, label='', unit='step', stream=None):
		self.total, self.label, self.unit = total, label, unit
		self.stream = stream or sys.stderr
		self.start = self._last = time.monotonic()
		self.done = 0
		self._bar = None
		if self.stream.isatty():
			try:
				from tqdm import tqdm
				self._bar = tqdm(total=total, desc=label, unit=unit, file=self.stream, leave=True, dynamic_ncols=True)
			except ImportError:
				pass
		self._line = self._bar is None and self.stream.isatty()

	def grow(self, total):
		"""A larger total: there is more to do than was thought at the start."""
		self.total = total
		if self._bar is not None: self._bar.total = total

	def update(self, done, **fields):
		"""`done` so far, not since the last call; fields are shown behind the bar."""
		step, self.done = done - self.done, done
		if self._bar is not None:
			self._bar.set_postfix({k: '%.3g' % v if isinstance(v, float) else v for k, v in fields.items()}, refresh=False)
			self._bar.update(step)
		elif time.monotonic() - self._last >= self.INTERVAL:
			self._last = time.monotonic()
			self._print(fields)

	def _print(self, fields):
		spent = time.monotonic() - self.start
		left = spent * (self.total - self.done) / self.done if self.done and self.total else float('nan')
		share = 100. * self.done / self.total if self.total else 0.
		words = ['%s: %3.0f %%' % (self.label, share), '%.6g of %.6g %s' % (self.done, self.total or 0, self.unit), '%.0f s' % spent, '%.0f s left' % left]
		words += ['%s %.3g' % (k, v) if isinstance(v, float) else '%s %s' % (k, v) for k, v in fields.items()]
		print(', '.join(words), file=self.stream, flush=True)

	def close(self, **fields):
		if self._bar is not None:
			self._bar.close()
		elif self.done and time.monotonic() - self.start >= self.INTERVAL:
			self._print(fields)

	def __enter__(self):
		return self

	def __exit__(self, *error):
		self.close()
