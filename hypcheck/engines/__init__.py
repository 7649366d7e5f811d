"""What collision engines do: each installed apart, asked by the protocol of commands, measured near contact."""
