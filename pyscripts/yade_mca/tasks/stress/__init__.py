# SPDX-License-Identifier: GPL-2.0-or-later
"""Task `stress`: numerical stability: what holds, what is refused, what fails. It starts in task.py."""
