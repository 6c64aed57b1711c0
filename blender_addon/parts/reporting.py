# SPDX-License-Identifier: GPL-3.0-or-later
"""How operators of parts say what is wrong."""

from .. import core
from .part_error import PartError


class Reporting:
    """Runs `run(context)` and reports what is wrong in one sentence."""

    def execute(self, context):
        try:
            return self.run(context) or {"FINISHED"}
        except (PartError, core.MissingCore) as error:
            text = str(error)
        except OSError as error:
            text = f"{error.filename}: {error.strerror}"
        except ValueError as error:  # sardf.Error is one; others are ours to mend
            if type(error).__module__.split(".")[0] != "sardf":
                raise
            text = str(error)
        self.report({"ERROR"}, text)
        return {"CANCELLED"}
