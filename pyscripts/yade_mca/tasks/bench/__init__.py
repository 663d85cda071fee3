# SPDX-License-Identifier: GPL-2.0-or-later
"""Task `bench`: run time against error, cost by phase. It starts in task.py."""
