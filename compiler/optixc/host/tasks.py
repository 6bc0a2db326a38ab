"""Modules that are compiled in tasks: creating one is cheap, any thread executes the task, the module tells how far it is."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from optixc.enums_program import ModuleCompileState
from optixc.errors import IllegalDuringTaskExecuteError, InvalidOperationError, InvalidValueError
from optixc.host.groups import Module, Program

Open = Callable[[], tuple[Any, list[dict[str, Any]]]]


class Task:
    """The work that is left of a module."""

    def __init__(self, module: TaskModule) -> None:
        self._module = module

    def execute(self, max_additional_tasks: int = 1) -> list[Task]:
        """Does the work on this thread and gives the tasks that it split off, none here. Raises what module_create would raise.

        A second call has nothing to do; one in another thread meanwhile waits.
        """
        if not isinstance(max_additional_tasks, int) or isinstance(max_additional_tasks, bool) or max_additional_tasks < 1:
            raise InvalidValueError(f"max_additional_tasks must be at least 1, not {max_additional_tasks!r}")
        self._module.compile()
        return []


class TaskModule(Module):
    """A module whose programs are there once its task was executed."""

    def __init__(self, open_source: Open, bound_values: Mapping[str, Any]) -> None:
        super().__init__(None, [], bound_values)
        self._open = open_source
        self._state = ModuleCompileState.NOT_STARTED
        self._executing = threading.Lock()

    def get_compilation_state(self) -> ModuleCompileState:
        """How far the compilation is."""
        return self._state

    def compile(self) -> None:
        """Opens the source; the error of a source that cannot be compiled is raised once."""
        with self._executing:
            if self._state is not ModuleCompileState.NOT_STARTED:
                return
            self._state = ModuleCompileState.STARTED
            try:
                unit, programs = self._open()
            except BaseException:
                self._state = ModuleCompileState.FAILED
                raise
            super().__init__(unit, programs, self.bound_values)
            self._state = ModuleCompileState.COMPLETED

    def destroy(self) -> None:
        """Frees the module and its task. Raises while the task is executing."""
        if not self._executing.acquire(blocking=False):
            raise IllegalDuringTaskExecuteError("a task of this module is executing; wait for it before destroy()")
        with_task = self._executing
        try:
            super().destroy()
            if self._state is ModuleCompileState.NOT_STARTED:
                self._state = ModuleCompileState.FAILED
        finally:
            with_task.release()

    def __getitem__(self, name: str) -> Program:
        self._check_complete()
        return super().__getitem__(name)

    def __iter__(self) -> Iterator[str]:
        self._check_complete()
        return super().__iter__()

    def _check_complete(self) -> None:
        if self._state is ModuleCompileState.FAILED:
            raise InvalidOperationError("this module has no programs, its task failed and said why; create it again from a mended source")
        if self._state is not ModuleCompileState.COMPLETED:
            raise InvalidOperationError(f"this module is {self._state.name}; execute its tasks before its programs are used")
