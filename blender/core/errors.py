# SPDX-License-Identifier: GPL-3.0-or-later
"""What is reported to the user as it stands."""


class DreampmError(Exception):
    """Something the user can mend; its text says what is wrong and what would be right."""
