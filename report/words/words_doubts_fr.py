"""Doubts in French: a title, what is said of one and of several with their names, what to do."""

DOUBTS = {
    "access-gap": (
        "Ce qui est permis n'est pas connu",
        "ce que {names} permet n'est pas connu",
        "ce qui est permis n'est pas connu à {n} endroits ({names})",
        "regarder les avertissements sur ces fichiers et la vue appliquée (--view enforced)",
    ),
    "analysed-in-parts": (
        "Une réponse sur une flotte analysée par parties",
        "des robots qui ne sont pas montrés, aucun doute n'est nommé",
        "des robots qui ne sont pas montrés, aucun doute n'est nommé",
        "analyser toute la flotte en mémoire, ou les robots qui importent",
    ),
    "backups-not-stated": (
        "Un stockage dont les sauvegardes ne sont pas indiquées",
        "les sauvegardes de {names} ne sont pas indiquées, aucune n'est supposée",
        "les sauvegardes de {n} stockages ne sont pas indiquées, aucune n'est supposée ({names})",
        "les indiquer dans le fichier d'annotations : backups: P30D ou backups: false",
    ),
    "bag-gap": (
        "Un enregistrement n'est pas entièrement connu",
        "l'enregistrement {names} n'est pas entièrement connu",
        "{n} enregistrements ne sont pas entièrement connus ({names})",
        "nommer les politiques du système enregistré, ou réparer l'enregistrement (rosprivacy bag dit ce qui manque)",
    ),
    "by-globs": (
        "Seul un motif répond d'un élément",
        "seul un motif répond de {names}",
        "seuls des motifs répondent de {n} éléments ({names})",
        "regarder chacun, puis garder ce qui a été vu : rosprivacy labels --pin",
    ),
    "careful-deny": (
        "Une recherche qu'une borne a coupée",
        "une borne a coupé ce qu'un DENY de {names} laisse de jokers",
        "une borne a coupé ce que {n} DENY laissent de jokers ({names})",
        "relever la borne des comparaisons",
    ),
    "empty-group": (
        "Des lignes d'une politique qui n'autorisent rien",
        "un groupe de lignes dans {names} n'a pas de règle et n'autorise rien",
        "{n} groupes de lignes n'ont pas de règle et n'autorisent rien ({names})",
        'y écrire publish="ALLOW" ou semblable, ou les retirer',
    ),
    "empty-include": (
        "Une inclusion qui n'apporte rien",
        "une inclusion dans {names} n'apporte rien",
        "{n} inclusions n'apportent rien ({names})",
        "corriger ce que l'inclusion choisit, ou la retirer",
    ),
    "fallback-taken": (
        "Un remplacement a été pris",
        "un remplacement (fallback) a été pris dans {names}",
        "{n} remplacements (fallback) ont été pris ({names})",
        "fournir le fichier inclus, ou retirer le remplacement",
    ),
    "joins-nothing": (
        "Un domaine ou une infrastructure qui n'est relié à rien",
        "un domaine ou une infrastructure dans {names} n'est relié à rien",
        "{n} domaines ou infrastructures ne sont reliés à rien ({names})",
        "nommer son domaine, ou un flux qui y mène ; omettre le domaine s'il doit rester seul",
    ),
    "leak-joins-nothing": (
        "Un domaine ou une infrastructure qui laisse sortir des données et n'est relié à rien",
        "un domaine ou une infrastructure dans {names} qui laisse sortir ou conserve des données n'est relié à rien",
        "{n} domaines ou infrastructures qui laissent sortir ou conservent des données ne sont reliés à rien ({names})",
        "nommer son domaine, ou un flux qui y mène ; omettre le domaine s'il doit rester seul",
    ),
    "made-without-warnings": (
        "Un texte sur le fonctionnement, fait sans avertissements",
        "le texte derrière {names} a été fait sans avertissements",
        "{n} textes sur le fonctionnement ont été faits sans avertissements ({names})",
        "refaire le texte avec -a, --include-hidden et 2>&1, et l'observer à nouveau",
    ),
    "mistaken-tilde": (
        "Un nom derrière ~ sans /",
        "un nom dans {names} n'a pas de / derrière ~ et est un autre nom",
        "{n} noms n'ont pas de / derrière ~ et sont d'autres noms ({names})",
        "écrire ~/ devant",
    ),
    "infrastructure-closes": (
        "Seul le fichier d'infrastructure ferme le chemin vers un point de sortie",
        "seul le fichier d'infrastructure ferme le chemin vers un point de sortie à {names}",
        "seul le fichier d'infrastructure ferme les chemins vers des points de sortie à {n} canaux ({names})",
        "regarder ce que le canal transporte, et l'annoter",
    ),
    "no-flow": (
        "Un élément hors de ROS qu'aucun flux n'atteint",
        "aucun flux n'atteint {names}",
        "aucun flux n'atteint {n} éléments hors de ROS ({names})",
        "dire dans le fichier d'annotations ce qui y entre, ou retirer l'élément",
    ),
    "no-reader": (
        "Des données que personne de connu ne lit",
        "{names} n'a pas de lecteur connu",
        "{n} canaux n'ont pas de lecteur connu ({names})",
        "fournir la politique de qui lit, ou regarder qui lit (rosprivacy observe)",
    ),
    "no-robot": (
        "Des dossiers d'un groupe de robots sans sa politique",
        "des dossiers d'un groupe dans {names} n'ont pas de politique et ne sont pas des robots",
        "des dossiers de {n} groupes n'ont pas de politique et ne sont pas des robots ({names})",
        "donner la politique à ces dossiers, ou les déplacer",
    ),
    "nothing-enforced": (
        "Rien n'est imposé à ce qui a été observé",
        "rien n'est imposé à {n} nœud ({names})",
        "rien n'est imposé à {n} nœuds ({names})",
        "regarder ce que tout programme sur le réseau peut lire (--view both) ; la politique que rosprivacy observe a écrite peut être imposée : ros2 security generate_artifacts -k KEYSTORE -p POLICY, et ROS_SECURITY_STRATEGY=Enforce",
    ),
    "observation-gap": (
        "Une observation à laquelle il manque quelque chose",
        "il manque quelque chose à l'observation ({names})",
        "il manque {n} choses à l'observation ({names})",
        "observer de nouveau jusqu'à ce qu'aucune lacune ne reste (rosprivacy observe), ou nommer une politique",
    ),
    "odd-namespace": (
        "Un espace de noms qui ne commence pas par /",
        "un espace de noms dans {names} ne commence pas par /",
        "{n} espaces de noms ne commencent pas par / ({names})",
        "écrire / devant",
    ),
    "paths-not-counted": (
        "Une recherche coupée par une limite",
        "une limite a coupé le compte des chemins",
        "une limite a coupé {n} comptes de chemins",
        "relever la limite, ou demander moins de catégories de données",
    ),
    "refused-name": (
        "Un nom qu'aucun nœud ROS ne peut avoir",
        "un nom dans {names} n'est pas de ceux qu'un nœud ROS peut avoir",
        "{n} noms ne sont pas de ceux qu'un nœud ROS peut avoir ({names})",
        "corriger le nom : il n'en rencontre aucun autre, ou les mauvais",
    ),
    "restricted": (
        "Seules certaines catégories de données ont été demandées",
        "seules certaines catégories de données ont été demandées",
        "seules certaines catégories de données ont été demandées",
        "demander toutes les catégories",
    ),
    "standard-closes": (
        "Seul le fichier des canaux standard ferme le chemin vers un point de sortie, sur un canal qui n'est pas à sa place",
        "seul le fichier des canaux standard ferme le chemin vers un point de sortie à {names}, qui n'est pas un canal standard à sa place",
        "seul le fichier des canaux standard ferme les chemins vers des points de sortie à {n} canaux qui ne sont pas à leur place ({names})",
        "regarder ce que le canal transporte, et l'annoter par son nom entier",
    ),
    "type-closes": (
        "Seul le type d'un canal ferme le chemin vers un point de sortie",
        "seul le type d'un canal ferme le chemin vers {names}",
        "seuls les types de canaux ferment les chemins vers {n} points de sortie ({names})",
        "regarder ce que le canal transporte, et le dire dans une annotation",
    ),
    "types-of-nothing": (
        "Des types observés de ce qui n'existe pas ici",
        "{names} donne des types de canaux ou de nœuds qui n'existent pas ici",
        "{n} fichiers donnent des types de canaux ou de nœuds qui n'existent pas ici ({names})",
        "donner aussi la politique de ce qui a été vu en fonctionnement, ou le fichier de ce système",
    ),
    "unread-file": (
        "Un fichier avec des droits qui n'a pas été lu",
        "{names} n'a pas été lu",
        "{n} fichiers n'ont pas été lus ({names})",
        "nommer le fichier, ou la politique qui l'inclut, ou le retirer du dossier",
    ),
}
WORDS = {
    "r.answer": "La réponse sur laquelle repose ce registre",
    "h.doubts": "Doutes",
    "doubt.sentence": "En doute : {doubts}.",
    "verdict.doubtful": "Non déterminé : tout n'est pas connu",
    "verdict.doubtful.means": "Aucun chemin vers un destinataire n'a été trouvé, mais quelque chose qui peut en cacher un n'est pas connu : la section sur les doutes le nomme. Tant qu'il n'est pas connu, rien ne peut être conclu.",
    "doubt.accepted.one": "{n} doute accepté",
    "doubt.accepted.many": "{n} doutes acceptés",
    "doubt.list": "Doutes : ce qui n'est pas connu, ou qui repose sur plus que la parole d'une personne ({n})",
    "doubt.breaks": "rompt le résultat",
    "doubt.rides": "accompagne le résultat",
    "doubt.is.accepted": "accepté jusqu'au {date} par {owner} : {reason}",
    "doubt.what.to.do": "Que faire : {do}",
    "doubt.none": "Aucun doute n'est connu.",
    **{
        f"doubt.{name}.{part}": text
        for name, texts in DOUBTS.items()
        for part, text in zip(("title", "one", "many", "do"), texts, strict=True)
    },
}
