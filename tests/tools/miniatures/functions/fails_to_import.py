"""Cannot be imported."""

import a_module_that_nobody_has

classify = a_module_that_nobody_has.classify
