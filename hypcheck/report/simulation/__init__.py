"""Files of `hypcheck simulate`: the JSON, and pictures drawn from it alone."""
