# SPDX-License-Identifier: GPL-3.0-or-later
"""What panels and operators share that show or change something in Blender's window."""

import textwrap

import bpy

LINE = 34  # characters that fit into the sidebar at its default width
POLL_SECONDS = 0.05


def lines(layout, texts, alert=False):
    """Sentences as labels, broken where the sidebar ends."""
    column = layout.column(align=True)
    column.alert = alert
    for text in texts:
        for row in textwrap.wrap(text, LINE, break_long_words=True):
            column.label(text=row)


def redraw(kinds=("VIEW_3D",)):
    """Draw the areas of these types again, in every window."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in kinds:
                area.tag_redraw()


class Watch:
    """The timer by which work in another thread is polled, and what is shown of that work: `stage`,
    one line for panel and status bar. Of the session, not of the file."""

    def __init__(self, kinds=("VIEW_3D",)):
        """`kinds`: the types of the areas whose panels show the work."""
        self.stage = ""
        self._kinds = kinds
        self._timer = None

    @property
    def begun(self):
        return self._timer is not None

    def begin(self, context, operator):
        """Call operator.modal() from now on."""
        manager = context.window_manager
        self._timer = manager.event_timer_add(POLL_SECONDS, window=context.window)
        manager.progress_begin(0, 100)
        manager.modal_handler_add(operator)

    def tell(self, context, stage, share, status=None):
        """Show the stage, and the share of the work that is done; `status` is the longer text of
        the status bar."""
        self.stage = stage
        context.window_manager.progress_update(100 * share)
        context.workspace.status_text_set(f"sardf: {status or stage} (Esc cancels)")
        redraw(self._kinds)

    def end(self, context):
        """Take back what the window shows; does nothing where nothing was begun."""
        if not self.begun:
            return
        context.window_manager.event_timer_remove(self._timer)
        self._timer = None
        context.window_manager.progress_end()
        for workspace in bpy.data.workspaces:  # another one may be shown than at the beginning
            workspace.status_text_set(None)
        redraw(self._kinds)


class Polling:
    """An operator whose work goes on in another thread while Blender stays usable.

    It has a `watch`; `title`, what is said to be cancelled; `cancel(context)`, which stops the work
    and ends the watch: on Esc, and where Blender ends the operator itself, because another file is
    loaded or the window closes; and `poll_work(context)`, which is called at every tick and returns
    what modal() does.
    """

    def modal(self, context, event):
        if not self.watch.begun:  # the add-on was disabled, and enabled again
            self.cancel(context)
            return {"CANCELLED"}
        if event.type == "ESC" and event.value == "PRESS":
            self.cancel(context)
            self.report({"INFO"}, f"{self.title} cancelled")
            return {"CANCELLED"}  # the thread ends by itself, within 0.1 s
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        return self.poll_work(context)
