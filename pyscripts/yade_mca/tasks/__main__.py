# SPDX-License-Identifier: GPL-2.0-or-later
import os
import sys

from .cli import main, readerGone

try:
	status = main()
	sys.stdout.flush()
except BrokenPipeError:
	if not readerGone(): raise
	os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # the interpreter flushes once more when it ends
	status = 141  # as any program that writes where nobody reads: 128 + SIGPIPE
sys.exit(status)
