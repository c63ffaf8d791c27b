/** The studio's page. */

import { mount } from "svelte";
import { followAddress } from "./app/route";
import Shell from "./app/Shell.svelte";
import { followTheme } from "./app/theme";
import { live, seat } from "./net/live";
import { rememberForceUnit } from "./ui/force";
import { listenForShortcuts } from "./ui/keys";
import "./tokens.css";
import "./style.css";

seat();
followTheme();
rememberForceUnit();
followAddress();
listenForShortcuts();
live().open();
mount(Shell, { target: document.body });
