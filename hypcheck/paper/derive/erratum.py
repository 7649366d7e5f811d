r"""An erratum to the paper, in LaTeX: formulas, propositions and procedures put right, each with a short proof.

What is computed elsewhere is taken from there: corrected formulas from the derivation, the smallest counterexamples
from the search, the figures of Table 5 from the ledger. The proofs are those of docs/mathematics.md, shortened.
"""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

from hypcheck.paper.derive.latex import formula, sentence
from hypcheck.paper.derive.selection import Selection
from hypcheck.paper.ledger.book import entries
from hypcheck.paper.ledger.entry import LedgerEntry
from hypcheck.paper.ledger.points import PointFacts
from hypcheck.paper.tower import PRINTED
from hypcheck.tables.streams import writing
from hypcheck.version import VERSION

COMPILER = "pdflatex"


def lines(_: Selection) -> Iterator[str]:
    """The whole note, whatever was chosen: an erratum is one."""
    ledger = {entry.number: entry for entry in entries()}
    text = _NOTE
    for name, value in _values(ledger).items():
        text = text.replace(f"<{name}>", value)
    yield from text.splitlines()


def _values(ledger: dict[str, LedgerEntry]) -> dict[str, str]:
    """What the note leaves to the ledger, by the names in it."""
    ring, beyond = _witnesses(ledger["Proposition 3.1"])[0], _witnesses(ledger["Proposition 5.2"])[0]
    without_c2, without_c1 = _witnesses(ledger["Proposition 5.1"])
    rotor = _witnesses(ledger["Table 3"])[0]
    hull, low = _witnesses(ledger["Table 4"])[0], _witnesses(ledger["Table 4, caption"])[0]
    return {
        "version": VERSION,
        "equation 11": formula(ledger["(11)"].correction),
        "equation 12": formula(_lambda_cubic(ledger["(12)"].correction)),
        "equation A2": formula(ledger["A.2b"].correction),
        "misled": _pair(_witnesses(ledger["(12)"])[0]),
        "ring": _pair(ring),
        "ring beyond": _pair(beyond),
        "zero c2": _pair(without_c2),
        "zero c1": _pair(without_c1),
        "rotor": _pair(rotor),
        "hull": _pair(hull),
        "low hull": _pair(low),
        "equal steps": sentence(ledger["Table 5, equal steps"].why),
        "second row": ", ".join(f"{figure:.4f}" for figure in PRINTED[1]),
        "t is": sentence(ledger["Table 5, t = 0.1"].why),
    }


def _witnesses(entry: LedgerEntry) -> list[PointFacts]:
    return [witness.facts for evidence in entry.evidence for witness in evidence.witnesses]


def _lambda_cubic(text: str) -> str:
    """(12) with its terms from the highest power of λ down, in two displays' worth of one line."""
    name, _, rest = text.partition(" = ")
    constant, _, others = rest.partition(" + ")
    return f"{name} = {others} {constant.replace('−', '− ', 1)}"


def _pair(facts: PointFacts) -> str:
    """A pair and its numbers, "a = 1, c = 2, centre (5/2, 0, 0): exterior, Δ = 0, …", as LaTeX."""
    point = facts.point
    numbers = rf"\Delta={facts.delta},\ c_2={facts.c2},\ c_1={facts.c1}"
    return rf"$a={point.a}$, $c={point.c}$, centre $({point.r},0,{point.z})$: {facts.position.label}, ${numbers}$"


def compile_note(path: Path) -> str:
    """Make the PDF beside the LaTeX file; what was done, or why nothing was, in a sentence.

    LaTeX runs in a folder of its own, so nothing but the PDF is left.
    """
    if shutil.which(COMPILER) is None:
        return f"not compiled: there is no {COMPILER} on this machine"
    with tempfile.TemporaryDirectory() as folder:
        command = [COMPILER, "-interaction=nonstopmode", "-halt-on-error", "-no-shell-escape", "note.tex"]
        shutil.copyfile(path, Path(folder, "note.tex"))
        try:
            done = subprocess.run(command, cwd=folder, capture_output=True, check=False, timeout=120)  # noqa: S603
        except subprocess.TimeoutExpired:
            return f"not compiled: {COMPILER} took longer than 120 s"
        if done.returncode:
            return f"not compiled: {COMPILER} ended with {done.returncode}; run it on {path} to see why"
        target = path.with_suffix(".pdf")
        with writing(str(target)) as file:
            file.write(Path(folder, "note.pdf").read_bytes())
    return f"wrote {target}"


_NOTE = r"""\documentclass[10pt]{article}
\usepackage{amsmath,amssymb}
\usepackage[a4paper,margin=19mm]{geometry}
\setlength{\parindent}{0pt}\setlength{\parskip}{3.2pt plus 1pt}
\newcommand{\head}[1]{\par\medskip\textbf{#1}\enspace}
\newcommand{\proof}{\par\textit{Proof.}\enspace}
\newcommand{\qed}{\hfill$\square$}
\pagestyle{plain}
\begin{document}
\begin{center}
{\large\bfseries Erratum to ``Algorithms for Determining Relative Position between\\
Spheroids and Hyperboloids with One Sheet''}\\[3pt]
{\small Drafted for the authors by \texttt{hypcheck} <version> (\texttt{hypcheck derive -{}-format erratum}).\\
The text that was read is a transcription; each misprint is to be compared with the printed page first.}
\end{center}

\textbf{Notation.} Numbers are the paper's. After Theorem~1, $a=\alpha/b$, $c=\gamma/d$, $A=a^2$, $B=c^2$,
$P=(x_0^2+y_0^2)/b^2$, $Q=z_0^2/d^2$, and $g(\lambda)=\lambda^3+c_2\lambda^2+c_1\lambda+c_0$ with the
coefficients of (14),
which is right. \emph{The ring} is the set of centres with $z_0=0$ and $r^2=(c^2+1)(a^2+c^2)/c^2$, where
$c^2>a$;
$r=\sqrt P$.

\head{1. Formulas.} In (11), if $f(\lambda)=\det(\lambda H+S)$ with the $4\times4$ matrices of the two quadrics,
in (12), and in the last line of the second display of Appendix~A, read
\begin{gather*}
<equation 11>,\\
<equation 12>,\\
<equation A2>.
\end{gather*}
In the text read ``$\mathcal H$ and $\mathcal S$, respectively defined by (7) and (8)''; ``if and only if
$\Delta>0$'' in
Proposition~3; ``$f$ given in (11)'' in Section~3.1; $\alpha/b\ge1$ for $a/b\ge1$ in Section~4 and for
$\alpha/b>1$ in
Proposition~5; $t=0.1$\,s for $t=0.1$\,m/s.
\proof $\lambda H+S$ is $\mathrm{diag}(1+\lambda/A,1+\lambda/A,1-\lambda/B)$ bordered by $-C$ and
$|C|^2-1-\lambda$, so its
determinant is $(A+\lambda)/(A^2B)$ times
\[g(\lambda)=(A+\lambda)(B-\lambda)(P+Q-1-\lambda)-AP(B-\lambda)-BQ(A+\lambda).\tag{$*$}\]
$A^2B=a^4c^2$; the coefficient of $\lambda^2$ in $(*)$ is $A-B+1-P-Q$, and $Q=z_c^2$ is missing in (12). For
<misled>, (12) as printed says contact. In Appendix~A, $(x_i^2+y_i^2)/b_s^2$ by (18) has the constant part
$(x_0^2+y_0^2+l^2)/b_s^2$: the $+\,l$ is stray; (21) and (23) are right.\qed

\head{2. Lemma.} \emph{The spheroid is exterior if and only if $g>0$ somewhere in $(0,B)$, and interior if and
only if $g>0$
somewhere in $(-A,0)$. One root of $g$ is at least $B$; the other two are complex, or lie together in one of
$(-\infty,-A]$, $[-A,0)$, $(0,B]$, $[B,\infty)$.}
\proof Let $h(X)=(X_1^2+X_2^2)/A-X_3^2/B-1$ and $-A<\lambda<B$. On $\mathcal H$, $|X-C|^2=|X-C|^2+\lambda h(X)$,
which is at
least the minimum over all $X$; that minimum is $\varphi(\lambda)+1$ with $\varphi=g/((A+\lambda)(B-\lambda))$.
So
$g(\lambda)>0$ keeps $\mathcal H$ out of the ball. Conversely $\varphi$ is concave; at its maximum the minimiser
lies on
$\mathcal H$ (at a pole one of several minimisers does), so $\sup\varphi=\mathrm{dist}(C,\mathcal H)^2-1$. The
maximum lies
on the side of $0$ that $\varphi'(0)=h(C)$ tells, which is the side of $C$. The rest follows from
$g(-A)=-AP(A+B)\le0$, $g(0)=-AB<0$, $g(B)=-BQ(A+B)\le0$.\qed

\head{3. Proposition 3, corrected.} \emph{Let $(\gamma/d)^2\ge\alpha/b$. (1)~The spheroid is exterior if and
only if
$\Delta>0$, $c_2<0$ and $c_1>0$, or its centre is on the ring. (2)~If $\Delta\le0$, there is contact, or the
centre is on
the ring.} The smallest counterexample to both printed statements: <ring>. On the ring the distance from contact
can be
large. The statement holds as printed wherever $z_0\ne0$. In the proof, ``$c_2<0$ and $c_1>0$ if and only if all
real roots
are positive'' needs $\Delta>0$.
\proof If $\Delta>0$, all roots are positive exactly if $c_2<0<c_1$ (Descartes; $c_0<0$). If so, they are not
all at least
$B$: their product is $AB\le B^3$, and they differ. So two lie in $(0,B]$ and $g>0$ between them: exterior. If
two are
negative, $g<0$ on $(0,B)$: not exterior. If $\Delta=0$, $g=(\lambda-m)^2(\lambda-s)$ is positive in $(-A,B)$
only for
$s<B$; then $m$ is the root that is at least $B$, and $(B-m)^2(B-s)=g(B)\le0$ leaves $m=B$; so $Q=0$, $g'(B)=0$
and
$s=A/B<B$: the ring, where $g>0$ on $(s,B)$ makes it exterior. If $\Delta<0$, the one real root is at least $B$:
contact.\qed

\head{4. Proposition 5, corrected.} \emph{Let $\alpha/b\ge1$. (1)~The spheroid is interior if and only if
$\Delta>0$ and not
both $c_2<0$ and $c_1>0$. (2)~If $\Delta\le0$, there is contact, or the centre is on the ring (which is
exterior).} The
printed (1) drops interior positions with $c_2=0$ or $c_1=0$: <zero c2>; <zero c1>. To the printed (2): <ring
beyond>. Where
$B>A+1$, as in the tower of Section~4, (1) is right as printed: $c_2<0$ there, and $c_1=0$ leaves $g$ no
negative root.
\proof If $\Delta>0$ and not all roots are positive, two are negative. They are not both at most $-A$: their
product would be
at least $A^2$, so the third, $AB$ over it, at most $B/A\le B$; it is at least $B$, so $A=1$ and both are $-A$,
which
$\Delta>0$ excludes. So $g>0$ between them, in $[-A,0)$: interior. If all are positive, $g<0$ on $(-A,0)$. The
case
$\Delta\le0$ is that of Proposition~3, which used no regime there.\qed

\head{5. Remarks 4 and 6} are right, and more is: no function of $g$ alone decides.
$g=(\lambda+\tfrac34)(\lambda+\tfrac12)(\lambda-8)$ is that of an interior pair ($A=1$, $B=3$, $P=9/32$,
$Q=175/32$) and of
one in contact ($2/5$, $15/2$, $147/1580$, $44/79$); $g=(\lambda-1)(\lambda-2)(\lambda-3)$ that of an exterior
pair
($12/5$, $5/2$, $1683/245$, $3/98$) and of one in contact ($12$, $1/2$, $91/5$, $3/10$).
\proof Put the numbers into $(*)$; $g>0$ between its two least roots, and the Lemma decides.\qed

\head{6. Tables 1 and 2 (Procedure 1), corrected.} For $(\gamma/d)^2\ge\alpha/b$, both for $\alpha/b\ge1$ and
$<1$:
\[\text{valid}\leftarrow\begin{cases}P-A-1>0\text{ and }(P-A-1)^2>4A&\text{if }Q=0,\\ \Delta>0\text{ and
}c_2<0\text{ and }c_1>0&
\text{if }Q\ne0.\end{cases}\]
As printed it refuses the movements to the ring, such as <ring>. Table~2 performs two divisions in each pass of
its loop,
by $b^2$ and by $d$; with $1/b^2$ and $1/d$ taken out of it the statement about additions and products holds.
\proof For $Q=0$, $g=(\lambda-B)(\lambda^2-E\lambda+A)$ with $E=P-A-1$. So $g>0$ in $(0,B)$ exactly where the
quadratic is
negative there. If $E>0$ and $E^2>4A$ it has two positive roots, the smaller below $\sqrt A\le B$; else it is
nowhere
negative for $\lambda>0$. For $Q\ne0$ there is no ring, and Proposition~3 applies.\qed

\head{7. Table 3 (Procedure 2.a), corrected.} For $\alpha/b_s\ge1$: valid if and only if, for $i=1,\dots,4$,
$\Delta(g_i)>0$ and
not both $c_2(g_i)<0$ and $c_1(g_i)>0$. As printed it refuses, for instance, four disjoint rotors on arms about
the axis, in
rotor radii: <rotor>.
\head{8. Table 4 (Procedure 2.b), corrected.} For $\alpha/b\ge1$: valid if and only if $\Delta>0$ and not both
$c_2<0$ and
$c_1>0$, or else Procedure~2.a as corrected says so. The rotors are to be asked whenever the bounding spheroid
is not
interior: for $(\gamma/d)^2<\alpha/b$ it can be in contact with $\Delta>0$ (<low hull>), so that the printed
procedure is
not valid ``for both cases''. For $(\gamma/d)^2\ge\alpha/b$ it refuses <hull>, without asking the rotors.
\proof Both are Proposition~5 as corrected, for the body and for each rotor, whose
$\alpha/b_s\ge\alpha/b\ge1$.\qed

\head{9. Section 4.} ``Contact, i.e.\ $\Delta\le0$'' and ``interior or exterior positions, which correspond to
$\Delta>0$''
hold inside a hyperboloid with $(\gamma/d)^2\ge\alpha/b\ge1$, as in the paper's tower, and not in general: see
3, 4 and~8. ``The
values of $\Delta$ closest to zero correspond to positions near the wall'' holds at one height only: in the
paper's tower
$\Delta=1.58\cdot10^{20}$ on the axis at the waist, 2\,m from the wall, and $2.01\cdot10^{20}$ at $z=17.8$\,m,
half a metre
from it. The tilt called pitch leaves the family (4): it brings a term $xz$.

\head{10. Table 5, second row: a question.} Is $t=0.2$ a misprint for $t=0.25$? The prediction looks $v\,t$
ahead, and
<equal steps>. Then the row <second row> is that of $t=0.25$. And for $t=0.1$ the figures are not independent of
the speed: <t is>.
\proof Compare the printed figures; nothing else is used, so this is an inference and no proof of what was
meant.\qed
\end{document}
"""
