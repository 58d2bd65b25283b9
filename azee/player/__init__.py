"""The player: a page on which a signer plays what one types; its server, and its static export."""
