"""The runs of an implementation: one process after another, as many as faults may cost."""

from __future__ import annotations

from collections.abc import Callable

from hypcheck.methods.faults import FaultError, StartError
from hypcheck.methods.session import Session


class OverError(Exception):
    """No further run is possible; the text says why. Raised by Runs and caught where questions are asked."""


class Runs:
    """Holds the session that runs, and begins another where it was lost. Raises StartError where the first fails.

    `start` begins a session; it is given the number of sessions before.
    """

    def __init__(self, start: Callable[[int], Session], most_restarts: int) -> None:
        self._start = start
        self._most = most_restarts
        self._count = 1
        self._lost_by = ""
        self._over = ""
        self._session: Session | None = start(0)
        self.restarts = 0
        self.declared = self._session.description
        self.scene = self._session.scene
        self.most = self._session.most
        self.longest = self._session.longest

    def session(self) -> Session:
        """The session that runs, begun anew if need be; raises OverError where that is not possible any more."""
        if self._session is None:
            if not self._over:
                self._session = self._begin()
            if self._session is None:
                raise OverError(self._over)
        return self._session

    def _begin(self) -> Session | None:
        if self._lost_by:
            if self.restarts == self._most:
                self._over = f"not asked: {self._most} restarts are used up; the last process: {self._lost_by}"
                return None
            self.restarts += 1
            self._lost_by = ""
        try:
            session = self._start(self._count)
        except StartError as error:
            self._over = f"not asked: it could not be started again: {error}"
            return None
        self._count += 1
        if session.description == self.declared:
            return session
        session.kill()
        self._over = "not asked: started again, it describes itself otherwise than before"
        return None

    def note(self, fault: FaultError) -> str:
        """Take note of a fault of the session that runs: what happened, with what was said on standard error."""
        session = self._session
        if not fault.fatal or session is None:
            return fault.reason
        session.kill()
        self._session = None
        self._lost_by = fault.reason + session.evidence
        return self._lost_by

    @property
    def stderr(self) -> tuple[str, ...]:
        """The last lines that the running process wrote on standard error, safe to print."""
        return self._session.stderr if self._session else ()

    def close(self) -> None:
        """Let the process leave. Another begins should anything be asked, and does not count as a restart."""
        session, self._session = self._session, None
        if session:
            session.close()

    def kill(self) -> None:
        """As close(), without waiting: it may be in the middle of a question."""
        session, self._session = self._session, None
        if session:
            session.kill()
